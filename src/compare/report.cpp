#include "compare/report.h"
