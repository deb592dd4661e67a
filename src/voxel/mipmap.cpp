#include "voxel/mipmap.h"
