#include "simulator/elasticity/elasticity.h"
