#include "cone/cone_set.h"
