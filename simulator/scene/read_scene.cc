#include "simulator/scene/read_scene.h"
