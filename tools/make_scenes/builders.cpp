#include "make_scenes/builders.h"
