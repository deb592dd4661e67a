#include "reference/bsdf.h"
