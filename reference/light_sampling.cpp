#include "reference/light_sampling.h"
