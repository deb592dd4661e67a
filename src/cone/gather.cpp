#include "cone/gather.h"
