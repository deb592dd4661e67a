#pragma once
#include <span>

#include "voxel/brick_volume.h"
#include "voxel/voxelize.h"

namespace voxref {

/// The mean visibility of the lights, as shading found it at the voxels; 0 where there is no surface.
class LightVisibility {
 public:
  /// @param shares one per occupied voxel, in [0,1]
  LightVisibility(const SurfaceGrid& surfaces, std::span<const float> shares);

  /// Trilinear; the volume's border goes on for ever. @param position world
  float operator()(const glm::vec3& position) const;

  size_t bytes() const { return shares_.bytes(); }

 private:
  Grid grid_;
  BrickVolume<float> shares_;
};

}  // namespace voxref
