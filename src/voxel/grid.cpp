#include "voxel/grid.h"
