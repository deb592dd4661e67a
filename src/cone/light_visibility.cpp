#include "cone/light_visibility.h"

#include "cone/interpolate.h"

namespace voxref {

LightVisibility::LightVisibility(const SurfaceGrid& surfaces, std::span<const float> shares)
    : grid_(surfaces.grid), shares_(surfaces.grid.size) {
  shares_.allocate(occupied_bricks(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i) shares_(surfaces.voxels[i]) = shares[i];
}

float LightVisibility::operator()(const glm::vec3& position) const {
  const Corners<float> corners = corners_clamped(shares_, to_float4(grid_.to_voxels(position)));
  if (corners.empty) return 0.0f;
  std::array<float, 8> shares;
  for (size_t i = 0; i < 8; ++i) shares[i] = *corners.texels[i];
  return mix_corners(shares, corners.f);
}

}  // namespace voxref
