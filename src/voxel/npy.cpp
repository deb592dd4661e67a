#include "voxel/npy.h"
