#pragma once
#include "progress.h"
#include "scene/scene.h"
#include "voxel/voxelize.h"

namespace voxref {

/// Voxelizes the static objects of a scene, or the dynamic ones, by clipping (spec section 2, exact; see voxelize).
SurfaceGrid voxelize_exact(const Scene& scene, const Grid& grid, bool dynamic, const VoxelizeOptions& options,
                           const Progress& progress);

}  // namespace voxref
