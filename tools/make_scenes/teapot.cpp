#include "make_scenes/teapot.h"
