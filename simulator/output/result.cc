#include "simulator/output/result.h"
