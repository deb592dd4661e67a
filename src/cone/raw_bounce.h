#pragma once
#include <optional>
#include <vector>

#include "cone/cone_set.h"
#include "cone/raw_march.h"
#include "cone/raw_volume.h"

namespace voxref {

/// Irradiance at voxels as the published shaders gather it (spec section 6, villegas2016): from the voxel's minimum
/// corner, two voxels along the normal, with cones that read the directional volumes alone. A sample at distance s
/// (voxels: 2, 4, 8, ...) stands for a cube of that size.
template <class Texel>
class RawVoxelGatherer {
 public:
  /// @param volume kept by reference @param max_distance in the grid's longest sides; none: to its diagonal
  RawVoxelGatherer(const BasicRawVolume<Texel>& volume, std::optional<float> max_distance);

  /// In [0,1]: the shader clamps it. @param normal unit
  glm::vec3 irradiance(const glm::ivec3& voxel, const glm::vec3& normal) const;

 private:
  glm::vec3 march(const glm::vec3& apex, const glm::vec3& direction) const;

  const BasicRawVolume<Texel>& volume_;
  ConeSet cones_;
  ConeSteps steps_;  ///< distances in voxels
};

}  // namespace voxref
