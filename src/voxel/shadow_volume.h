#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "voxel/voxelize.h"

namespace voxref {

/// The published shaders' shadow march through a volume of occupied voxels (spec section 3, villegas2016). Positions
/// and distances are in texture space: the grid's longest side is 1, its minimum corner the origin.
class ShadowVolume {
 public:
  /// Voxels whose opacity is 0 count as empty.
  explicit ShadowVolume(const SurfaceGrid& surfaces);

  /// 1 - v, where v grows by (1 - v) k / t at every sample whose trilinear filter meets an occupied voxel, t from 2 in
  /// steps of 1 voxel, as long as v is at most 1: in [0,1], but for a last hit with k > t.
  /// @param direction unit @param hit k = hit^2; where k is above 1 the first hit ends in darkness
  float visibility(const glm::vec3& from, const glm::vec3& direction, float distance, float hit) const;

  size_t bytes() const;

 private:
  static constexpr int side = 8;  // cells of a block, whose rows are bytes
  using Block = std::array<uint64_t, side>;
  static constexpr uint32_t absent = ~0u;

  /// Marks cells (x, y, z) and (x + 1, y, z).
  void mark_two(const glm::ivec3& cell);
  Block& block_of(const glm::ivec3& cell);
  void measure_gaps();
  size_t block_index(const glm::ivec3& cell) const {
    return size_t(cell.x / side) +
           size_t(blocks_.x) * (size_t(cell.y / side) + size_t(blocks_.y) * size_t(cell.z / side));
  }
  /// Whether a bit of an existing block is set.
  static bool bit(const Block& block, const glm::ivec3& v) {
    return (block[size_t(v.z % side)] >> (v.x % side + side * (v.y % side)) & 1u) != 0;
  }
  bool occupied(const glm::ivec3& voxel) const;
  /// Whether the trilinear filter in a cell meets an occupied voxel: those with weight 0 do not count.
  bool hits(const Block& cells, const glm::ivec3& cell, const glm::vec3& fraction) const;

  glm::ivec3 size_{0}, blocks_{0};
  float resolution_ = 1.0f;  // voxels along the longest side
  // Cell c is what a filter reads that lies between the centres of voxels c - 1 and c along each axis; it is marked
  // when any of the eight is occupied. So the march reads one bit per sample, and skips blocks without any.
  std::vector<uint32_t> slots_;
  std::vector<uint8_t> gaps_;  // blocks to the nearest one that is not absent, in the maximum norm; at most 255
  std::vector<Block> cells_, voxels_;
};

}  // namespace voxref
