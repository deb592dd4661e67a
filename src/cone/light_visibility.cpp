#include "cone/light_visibility.h"

#include "cone/raw_lookup.h"

namespace voxref {

LightVisibility::LightVisibility(const SurfaceGrid& surfaces, std::span<const float> shares)
    : grid_(surfaces.grid), shares_(surfaces.grid.size) {
  shares_.allocate(occupied_bricks(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i) shares_(surfaces.voxels[i]) = shares[i];
}

float LightVisibility::operator()(const glm::vec3& position) const {
  const auto read = [](float share) { return Float4{share, share, share, share}; };
  return trilinear_clamped(shares_, grid_.to_voxels(position), read)[0];
}

}  // namespace voxref
