#include "scene/reflectance.h"
