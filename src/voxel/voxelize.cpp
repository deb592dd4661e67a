#include "voxel/voxelize.h"
