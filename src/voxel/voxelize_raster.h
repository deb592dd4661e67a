#pragma once
#include "progress.h"
#include "scene/scene.h"
#include "voxel/voxelize.h"

namespace voxref {

/// Voxelizes the static objects of a scene, or the dynamic ones, as the published shaders do: every triangle is drawn
/// along its main axis, and each of its pixels averages base colour, normal and emission into one voxel, in draw order
/// (spec section 2, raster). Textures are looked up without decoding sRGB, alpha multiplies the colour and makes no
/// holes unless it is 0, and emission takes the base colour's texel.
/// With options.average = area the bytes are left out: a voxel holds the plain mean of its fragments, each of which
/// counts as one face of a voxel.
/// @param before of running_floor8: voxels that are there already; with options.static_wins they stay as they are
/// @return them and what was drawn
SurfaceGrid voxelize_raster(const Scene& scene, const SurfaceGrid& before, bool dynamic, const VoxelizeOptions& options,
                            const Progress& progress);

}  // namespace voxref
