#include "compare/flip.h"
