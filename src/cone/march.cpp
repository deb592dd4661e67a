#include "cone/march.h"
