#include "simulator/fault/friction_law.h"
