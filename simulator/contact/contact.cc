#include "simulator/contact/contact.h"
