#include "simulator/scene/json_document.h"
