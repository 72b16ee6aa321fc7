#include "simulator/output/fault_operator.h"
