#include "compare/picture.h"
