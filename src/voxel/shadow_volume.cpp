#include "voxel/shadow_volume.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace voxref {

namespace {

/// Steps of one voxel from `position` that stay inside the block of `side` cells around `cell`.
int steps_inside(const glm::vec3& position, const glm::vec3& inverse_direction, const glm::ivec3& cell, int side) {
  constexpr float rounding = 0.01f;  // voxels; far above that of positions, far below a step
  float shortest = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const float low = float(cell[axis] / side * side) - position[axis];
    const float to_end = inverse_direction[axis] > 0.0f ? low + float(side) : low;
    shortest = std::min(shortest, to_end * inverse_direction[axis]);  // infinite or NaN where it does not move
  }
  return std::max(1, int(shortest - rounding));
}

}  // namespace

ShadowVolume::ShadowVolume(const SurfaceGrid& surfaces)
    : size_(surfaces.grid.size),
      blocks_(size_ / side + 1),
      resolution_(float(std::max({size_.x, size_.y, size_.z}))),
      slots_(size_t(blocks_.x) * size_t(blocks_.y) * size_t(blocks_.z), absent) {
  for (size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces.albedo[i].a == 0.0f) continue;
    const glm::ivec3& v = surfaces.voxels[i];
    for (int corner = 0; corner < 8; ++corner) mark(v + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2));
    voxels_[slots_[block_index(v)]][size_t(v.z % side)] |= uint64_t{1} << (v.x % side + side * (v.y % side));
  }
}

void ShadowVolume::mark(const glm::ivec3& cell) {
  uint32_t& slot = slots_[block_index(cell)];
  if (slot == absent) {
    slot = uint32_t(cells_.size());
    cells_.emplace_back();
    voxels_.emplace_back();
  }
  cells_[slot][size_t(cell.z % side)] |= uint64_t{1} << (cell.x % side + side * (cell.y % side));
}

bool ShadowVolume::occupied(const glm::ivec3& voxel) const {
  const uint32_t slot = slots_[block_index(voxel)];
  return slot != absent && bit(voxels_[slot], voxel);
}

bool ShadowVolume::hits(const Block& cells, const glm::ivec3& cell, const glm::vec3& fraction) const {
  if (!bit(cells, cell)) return false;
  if (fraction.x > 0.0f && fraction.y > 0.0f && fraction.z > 0.0f) return true;
  const glm::ivec3 reach(fraction.x > 0.0f, fraction.y > 0.0f, fraction.z > 0.0f);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
    if (offset != glm::min(offset, reach)) continue;
    if (occupied(glm::clamp(cell - 1 + offset, glm::ivec3(0), size_ - 1))) return true;
  }
  return false;
}

float ShadowVolume::visibility(const glm::vec3& from, const glm::vec3& direction, float distance, float hit) const {
  const float step = 1.0f / resolution_, k = hit * hit;
  const glm::vec3 end = glm::vec3(size_) / resolution_, inverse_direction = 1.0f / direction;
  float blocked = 0.0f;
  for (float t = 2.0f * step; blocked <= 1.0f && t <= distance;) {
    const glm::vec3 p = direction * t + from;
    if (!(p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && p.x <= end.x && p.y <= end.y && p.z <= end.z)) break;
    const glm::vec3 texel = p * resolution_ - 0.5f;
    // At least -0.5, so that adding 1 makes truncation the floor; below 0 the edge's texel alone is read.
    const glm::ivec3 cell(texel + 1.0f);
    const uint32_t slot = slots_[block_index(cell)];
    if (slot == absent) {
      t += float(steps_inside(texel + 1.0f, inverse_direction, cell, side)) * step;
      continue;
    }
    if (hits(cells_[slot], cell, texel - glm::vec3(cell - 1))) {
      if (k > 1.0f) return 0.0f;
      blocked += (1.0f - blocked) * k / t;
    }
    t += step;
  }
  return 1.0f - blocked;
}

}  // namespace voxref
