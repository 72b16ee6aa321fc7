#include "simulator/mesh/mesh_spec.h"
