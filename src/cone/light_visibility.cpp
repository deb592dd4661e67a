#include "cone/light_visibility.h"

#include "cone/texel_lanes.h"

namespace voxref {

LightVisibility::LightVisibility(const SurfaceGrid& surfaces, std::span<const float> shares)
    : grid_(surfaces.grid), shares_(surfaces.grid.size) {
  shares_.allocate(occupied_bricks(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i) shares_(surfaces.voxels[i]) = shares[i];
}

float LightVisibility::operator()(const glm::vec3& position) const {
  const Float4 p = to_float4(grid_.to_voxels(position));
  TexelLanes at;
  locate_clamped(to_int4(shares_.size()) - 1, Int8{}, Float8{} + p[0], Float8{} + p[1], Float8{} + p[2],
                 Float8{} + 1.0f, at);
  return visit_lane(shares_, at, 0, [](const auto& corners, const auto& share) {
    float sum = 0.0f;
    for (size_t i = 0; i < 8; ++i) sum += share[i] * corners[i];
    return sum;
  });
}

}  // namespace voxref
