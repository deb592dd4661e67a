#include "scene/surface.h"
