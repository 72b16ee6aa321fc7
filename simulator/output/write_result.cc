#include "simulator/output/write_result.h"
