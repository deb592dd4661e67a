#include "voxel/shadow_volume.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "voxel/floor.h"

namespace voxref {

namespace {

/// Steps of one voxel from `position` that stay inside the cube of blocks that reaches gap - 1 blocks around the one of
/// `cell`. @param gap at least 1
int steps_inside(const glm::vec3& position, const glm::vec3& inverse_direction, const glm::ivec3& cell, int side,
                 int gap) {
  constexpr float rounding = 0.01f;  // voxels; far above that of positions, far below a step
  const float ahead = float(gap * side), behind = float((gap - 1) * side);
  float shortest = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const float low = float(cell[axis] & ~(side - 1)) - position[axis];
    const float to_end = inverse_direction[axis] > 0.0f ? low + ahead : low - behind;
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
    for (int yz = 0; yz < 4; ++yz) mark_two(v + glm::ivec3(0, yz & 1, yz >> 1));
    voxels_[slots_[block_index(v)]][size_t(v.z % side)] |= uint64_t{1} << (v.x % side + side * (v.y % side));
  }
  cells_.shrink_to_fit();
  voxels_.shrink_to_fit();
  measure_gaps();
}

ShadowVolume::Block& ShadowVolume::block_of(const glm::ivec3& cell) {
  uint32_t& slot = slots_[block_index(cell)];
  if (slot == absent) {
    slot = uint32_t(cells_.size());
    cells_.emplace_back();
    voxels_.emplace_back();
  }
  return cells_[slot];
}

void ShadowVolume::mark_two(const glm::ivec3& cell) {
  const int x = cell.x % side, row = side * (cell.y % side);
  const size_t slice = size_t(cell.z % side);
  if (x < side - 1) {
    block_of(cell)[slice] |= uint64_t{3} << (x + row);
    return;
  }
  block_of(cell)[slice] |= uint64_t{1} << (x + row);
  block_of(cell + glm::ivec3(1, 0, 0))[slice] |= uint64_t{1} << row;
}

// The distance transform of Rosenfeld and Pfaltz 1968: one pass forwards that looks at the neighbours before, one
// backwards that looks at those behind; exact in the maximum norm.
void ShadowVolume::measure_gaps() {
  gaps_.resize(slots_.size());
  std::ranges::transform(slots_, gaps_.begin(), [](uint32_t slot) { return uint8_t(slot == absent ? 255 : 0); });
  const auto shorten = [&](const glm::ivec3& block, int sign) {
    const size_t at = block_index(side * block);
    int gap = gaps_[at];
    for (int i = 0; i < 13 && gap > 1; ++i) {  // the half of the 26 neighbours that comes earlier in z, y, x
      const glm::ivec3 neighbor = block + sign * glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (glm::clamp(neighbor, glm::ivec3(0), blocks_ - 1) == neighbor)
        gap = std::min(gap, gaps_[block_index(side * neighbor)] + 1);
    }
    gaps_[at] = uint8_t(gap);
  };
  const int count = int(slots_.size());
  const auto block = [&](int i) {
    return glm::ivec3(i % blocks_.x, i / blocks_.x % blocks_.y, i / blocks_.x / blocks_.y);
  };
  for (int i = 0; i < count; ++i) shorten(block(i), 1);
  for (int i = count - 1; i >= 0; --i) shorten(block(i), -1);
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

size_t ShadowVolume::bytes() const {
  return slots_.capacity() * sizeof(uint32_t) + gaps_.capacity() +
         (cells_.capacity() + voxels_.capacity()) * sizeof(Block);
}

float ShadowVolume::visibility(const glm::vec3& from, const glm::vec3& direction, float distance, float hit) const {
  const float step = 1.0f / resolution_, k = hit * hit;
  const glm::vec3 end = glm::vec3(size_) / resolution_, inverse_direction = 1.0f / direction;
  float blocked = 0.0f;
  for (float t = 2.0f * step; blocked <= 1.0f && t <= distance;) {
    const glm::vec3 p = direction * t + from;
    if (!(p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && p.x <= end.x && p.y <= end.y && p.z <= end.z)) break;
    const glm::vec3 texel = p * resolution_ - 0.5f;
    const glm::ivec3 cell(floor_to_int(texel.x) + 1, floor_to_int(texel.y) + 1, floor_to_int(texel.z) + 1);
    const size_t block = block_index(cell);
    const uint32_t slot = slots_[block];
    if (slot == absent) {
      t += float(steps_inside(texel + 1.0f, inverse_direction, cell, side, gaps_[block])) * step;
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
