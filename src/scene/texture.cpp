#include "scene/texture.h"
