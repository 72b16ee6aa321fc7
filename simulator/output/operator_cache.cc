#include "simulator/output/operator_cache.h"
