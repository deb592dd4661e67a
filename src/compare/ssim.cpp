#include "compare/ssim.h"
