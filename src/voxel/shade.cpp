#include "voxel/shade.h"
