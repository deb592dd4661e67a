#include "reference/sampler.h"
