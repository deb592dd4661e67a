#include "cone/medium.h"
