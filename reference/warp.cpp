#include "reference/warp.h"
