#pragma once
#include <glm/vec3.hpp>
#include <optional>
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
enum class ShadePosition : uint8_t {
  centroid,  ///< of the surface in the voxel
  corner     ///< the voxel's minimum corner, half a voxel along the normal
};
enum class ShadeNormalization : uint8_t {
  lambert,  ///< albedo / pi
  none      ///< albedo
};

struct ShadeOptions {
  ShadePosition position = ShadePosition::centroid;
  bool two_sided = true;         ///< where opposite normals cancel, the voxel is lit from both sides
  bool normal_weighted = false;  ///< sum over axes of n_a^2 max(sign(n_a) l_a, 0) in place of max(n.l, 0)
  ShadeNormalization normalization = ShadeNormalization::lambert;
  VoxelShadow shadow = VoxelShadow::rays;
  /// Of the published shadow march (ShadowVolume); none: the voxels' extinction is marched.
  std::optional<float> shadow_hit{};
};

/// What light does to each occupied voxel, in SurfaceGrid's order.
struct Shading {
  std::vector<glm::vec3> radiance;  ///< outgoing, W/(sr m^2); not premultiplied
  std::vector<float> visibility;    ///< mean over the lights of the share that arrives, in [0,1]; 0 without lights
  size_t shadow_bytes = 0;          ///< of the volume that shadows were marched through, which is gone
};

/// Radiance of each occupied voxel: emission + albedo/pi x irradiance x visibility of the punctual lights, at the
/// voxel's centroid, with max(n.l, 0) of the unit mean normal: a voxel stands for its surface's front. Where opposite
/// normals cancel (mean normal shorter than two_sided_length) the voxel is lit as a sheet that faces the light with the
/// mean |cos| of a random orientation, 1/2. Shadow rays start half a voxel off the surface. Spec section 3; the options
/// turn the radiometric profile into villegas2016. Voxels whose opacity is 0 stay dark, black ones have visibility 0.
/// @param caster may be null unless shadow is `rays`
Shading shade(const Scene& scene, const Caster* caster, const SurfaceGrid& surfaces, const LightOptions& light,
              const ShadeOptions& options, const Progress& progress = {});

}  // namespace voxref
