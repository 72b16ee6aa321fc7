#include "simulator/plan/plan.h"
