#include "cone/empty_space.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace voxref {

template <class Texel>
EmptySpace::EmptySpace(const BrickVolume<Texel>& base)
    : blocks_((base.size() + side - 1) / side), occupied_(size_t(blocks_.x) * size_t(blocks_.y) * size_t(blocks_.z)) {
  using Volume = BrickVolume<Texel>;
  const glm::ivec3& bricks = base.brick_grid();
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) {
        const uint32_t slot = base.slot({x, y, z});
        if (slot == Volume::absent) continue;
        const auto texels = base.brick(slot);
        for (int i = 0; i < int(Volume::texels_per_brick); ++i)
          if (decode_alpha(texels[size_t(i)]) > 0.0f)
            occupy(Volume::side * glm::ivec3(x, y, z) + glm::ivec3(i & 7, i >> 3 & 7, i >> 6));
      }
}

void EmptySpace::occupy(const glm::ivec3& v) {
  const glm::ivec3 low = glm::max(v - 1, glm::ivec3(0)) / side, high = v / side;
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) occupied_[index({x, y, z})] = 1;
}

float EmptySpace::reach(const glm::vec3& p, const glm::vec3& way) const {
  const glm::vec3 q = p - 0.5f;
  const glm::ivec3 block = glm::ivec3(q) / side;
  if (q.x < 0.0f || q.y < 0.0f || q.z < 0.0f || block.x >= blocks_.x || block.y >= blocks_.y || block.z >= blocks_.z)
    return 0.0f;
  if (occupied_[index(block)]) return 0.0f;
  constexpr float margin = 1e-3f;  // voxels: rounding shall not carry a look-up into the next block
  float reach = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0.0f) continue;
    const float end = float(side * (block[axis] + (way[axis] > 0.0f)));
    reach = std::min(reach, (end - q[axis]) / way[axis] - margin / std::abs(way[axis]));
  }
  return reach;
}

template EmptySpace::EmptySpace(const BrickVolume<glm::vec4>&);
template EmptySpace::EmptySpace(const BrickVolume<Rgba16f>&);
template EmptySpace::EmptySpace(const BrickVolume<Rgba8>&);

}  // namespace voxref
