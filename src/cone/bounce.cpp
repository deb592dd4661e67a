#include "cone/bounce.h"
