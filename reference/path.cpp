#include "reference/path.h"
