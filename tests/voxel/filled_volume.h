#pragma once
#include <functional>
#include <vector>

#include "voxel/mipmap.h"

// Volumes whose texels a function gives.
namespace voxref {

using Base = BrickVolume<glm::vec4>;
using Fill = std::function<glm::vec4(const glm::ivec3&)>;

template <class Visit>
void for_each_voxel(const glm::ivec3& size, Visit&& visit) {
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) visit(glm::ivec3(x, y, z));
}

inline Base make_base(const glm::ivec3& size, const Fill& fill) {
  Base base(size);
  std::vector<glm::ivec3> bricks;
  for_each_voxel(base.brick_grid(), [&](const glm::ivec3& b) {
    bool used = false;
    for_each_voxel(glm::min(size - b * Base::side, glm::ivec3(Base::side)),
                   [&](const glm::ivec3& v) { used |= fill(b * Base::side + v) != glm::vec4(0.0f); });
    if (used) bricks.push_back(b);
  });
  base.allocate(bricks);
  for_each_voxel(size, [&](const glm::ivec3& v) {
    if (const glm::vec4 texel = fill(v); texel != glm::vec4(0.0f)) base(v) = texel;
  });
  return base;
}

inline Pyramid filtered(const glm::ivec3& size, const Fill& fill, MipmapFilter filter = MipmapFilter::anisotropic) {
  return mipmap(Grid{size, glm::vec3(0.0f), 1.0f}, make_base(size, fill), {filter});
}

}  // namespace voxref
