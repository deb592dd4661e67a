#include "make_scenes/shapes.h"
