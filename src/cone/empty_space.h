#pragma once
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "voxel/mipmap.h"

namespace voxref {

/// Where look-ups in a base volume find no opacity, in blocks of 4^3 cells: shadow cones leap over them.
class EmptySpace {
 public:
  template <class Texel>
  explicit EmptySpace(const BrickVolume<Texel>& base);

  /// How far from p one can go along `way` with every trilinear look-up on the way finding opacity 0; 0: not at all.
  /// @param p in voxels @param way voxels per unit of distance
  float reach(const glm::vec3& p, const glm::vec3& way) const;

 private:
  static constexpr int side = 4;  // small: the start of a cone, where its steps are shortest, lies near surfaces
  size_t index(const glm::ivec3& block) const {
    return size_t(block.x) + size_t(blocks_.x) * (size_t(block.y) + size_t(blocks_.y) * size_t(block.z));
  }
  /// Marks the blocks with a cell, between the centres of v - 1 and v or of v and v + 1, that touches voxel v.
  void occupy(const glm::ivec3& v);

  glm::ivec3 blocks_;
  std::vector<uint8_t> occupied_;
};

}  // namespace voxref
