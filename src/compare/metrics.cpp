#include "compare/metrics.h"
