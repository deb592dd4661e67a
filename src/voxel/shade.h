#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "progress.h"
#include "scene/caster.h"
#include "scene/scene.h"
#include "voxel/voxelize.h"

namespace voxref {

enum class VoxelShadow : uint8_t {
  none,
  rays,   ///< shadow rays to the triangles
  volume  ///< a march through the voxels' opacity
};

struct ShadeOptions {
  VoxelShadow shadow = VoxelShadow::rays;
};

/// Outgoing radiance of each occupied voxel, W/(sr m^2), in SurfaceGrid's order: emission + albedo/pi x irradiance x
/// visibility of the punctual lights, at the voxel's centroid, with max(n.l, 0) of the unit mean normal: a voxel stands
/// for its surface's front. Where opposite normals cancel (mean normal shorter than two_sided_length) the voxel is lit
/// as a sheet that faces the light with the mean |cos| of a random orientation, 1/2. Shadow rays start half a voxel off
/// the surface. Spec section 3 (radiometric).
/// @param caster may be null unless shadow is `rays`
std::vector<glm::vec3> shade(const Scene& scene, const Caster* caster, const SurfaceGrid& surfaces,
                             const ShadeOptions& options, const Progress& progress = {});

}  // namespace voxref
