#pragma once
#include <optional>
#include <span>
#include <vector>

#include "cone/gather.h"
#include "progress.h"
#include "voxel/mipmap.h"

namespace voxref {

struct BounceOptions {
  std::optional<int> count;  ///< 0 to 1000; none: until one more would add less than 1 % of the total
  int cones = 6;             ///< over the hemisphere of each voxel
};

struct BounceResult {
  std::vector<glm::vec3> radiance;  ///< per occupied voxel, W/(sr m^2), after the last bounce
  Pyramid pyramid;                  ///< filtered from it
  int bounces = 0;                  ///< how many were made
  double gain = 0.0;                ///< last addition over the one before (loop gain); 0 with fewer than two bounces
};

/// L_0 = `direct`; L_(k+1) = L_0 + albedo/pi E(L_k), gathered with cones at every occupied voxel and filtered again after
/// each. Spec section 6. @throws Error when the additions do not shrink (gain at or above 1)
BounceResult bounce(const SurfaceGrid& surfaces, std::span<const glm::vec3> direct, const BounceOptions& options,
                    const ConeOptions& cone, const MipmapOptions& mipmap, const glm::vec3& background,
                    const Progress& progress = {});

}  // namespace voxref
