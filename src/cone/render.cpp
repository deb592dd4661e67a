#include "cone/render.h"
