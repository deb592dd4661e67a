#include "scene/tangents.h"
