#include "scene/light.h"
