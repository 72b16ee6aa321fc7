#include "simulator/loading/run_case.h"
