#pragma once
#include <optional>
#include <span>
#include <vector>

#include "cone/gather.h"
#include "progress.h"
#include "voxel/mipmap.h"

namespace voxref {

struct BounceOptions {
  std::optional<int> count;             ///< 0 to 1000; none: until one more would add less than 1 % of the total
  int cones = 6;                        ///< over the hemisphere of each voxel, or published_cones
  std::optional<float> max_distance{};  ///< of the published cones, in the grid's longest sides; none: to the box's end
};

template <class Texel>
struct BasicBounceResult {
  std::vector<glm::vec3> radiance;  ///< per occupied voxel, W/(sr m^2), after the last bounce
  BasicPyramid<Texel> pyramid;      ///< filtered from it
  int bounces = 0;                  ///< how many were made
  Clamping clamped;                 ///< by the last bounce
  size_t depth_bytes = 0;           ///< held beside the pyramid while it was made ready for cones
  double gain = 0.0;                ///< last addition over the one before (loop gain); 0 with fewer than two bounces
};
using BounceResult = BasicBounceResult<glm::vec4>;

/// L_0 = `direct`; L_(k+1) = L_0 + albedo/pi E(L_k), gathered with cones at every occupied voxel and filtered again
/// after each. Spec section 6. A voxel gathers over the hemisphere of its mean normal; where opposite normals cancel
/// (shorter than two_sided_length) over both hemispheres, and takes the mean. Additions are compared as sums of
/// luminance over the voxels. @throws Error when they do not shrink (gain at or above 1) though nothing bounds them
BounceResult bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct, const BounceOptions& options,
                    const ConeOptions& cone, const MipmapOptions& mipmap, const glm::vec3& background,
                    const Progress& progress = {});

/// The same where `direct` is filtered already; takes over that pyramid's memory.
template <class Texel>
BasicBounceResult<Texel> bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct,
                                BasicPyramid<Texel>&& filtered, const BounceOptions& options, const ConeOptions& cone,
                                const MipmapOptions& mipmap, const glm::vec3& background,
                                const Progress& progress = {});

}  // namespace voxref
