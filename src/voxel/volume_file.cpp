#include "voxel/volume_file.h"
