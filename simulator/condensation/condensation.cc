#include "simulator/condensation/condensation.h"
