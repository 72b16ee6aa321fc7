#include "simulator/linalg/cholesky.h"
