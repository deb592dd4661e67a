#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "voxel/floor.h"
#include "voxel/mipmap.h"

namespace voxref {

/// One bit for each texel of a volume, in blocks of 8^3; blocks without a bit that is set take no memory but their
/// table entry.
class BitBlocks {
 public:
  static constexpr int side = 8;
  using Block = std::array<uint64_t, side>;  ///< a slice per z, in it a byte per y
  static constexpr uint32_t absent = ~0u;

  BitBlocks() = default;
  /// @param size bits per side
  explicit BitBlocks(const glm::ivec3& size)
      : blocks_((size + side - 1) / side), slots_(size_t(blocks_.x) * size_t(blocks_.y) * size_t(blocks_.z), absent) {}

  const glm::ivec3& block_grid() const { return blocks_; }
  void reserve(size_t blocks) { bits_.reserve(blocks); }
  /// Block of the given block coordinates, null where it has no bits.
  const Block* find(const glm::ivec3& block) const {
    const uint32_t slot = slots_[index(block)];
    return slot == absent ? nullptr : &bits_[slot];
  }
  /// Sets bits of a slice of a block.
  void set(const glm::ivec3& block, int z, uint64_t bits);

 private:
  size_t index(const glm::ivec3& block) const {
    return size_t(block.x) + size_t(blocks_.x) * (size_t(block.y) + size_t(blocks_.y) * size_t(block.z));
  }

  glm::ivec3 blocks_{0};
  std::vector<uint32_t> slots_;
  std::vector<Block> bits_;
};

/// Where in a pyramid look-ups may find anything: three of four samples of cones lie in empty space, and one bit tells.
/// Cell c of a level lies between the centres of texels c - 1 and c along each axis, so that a trilinear look-up reads
/// the eight texels around one cell. It counts as occupied when any of these holds something, or a texel of a finer
/// level inside of them: where a level is empty, so are all finer ones.
class Occupancy {
 public:
  Occupancy() = default;
  template <class Texel>
  explicit Occupancy(const BasicPyramid<Texel>& pyramid);
  /// Of a pyramid that is filtered from these surfaces.
  explicit Occupancy(const SurfaceGrid& surfaces);

  /// Whether a look-up at p in this level, or in a finer one, may find something; texels at the border may go on for
  /// ever. @param level 0 is the base, k is BasicPyramid::levels[k - 1] @param p finite; voxels
  bool operator()(int level, const Float4& p) const {
    const Int4 last = last_ >> level;
    const Float4 q = clamp(p * scale(level) - 0.5f, Float4{} - 1.0f, to_float4(last));
    return bit(level, to_ivec3(floor_to_int(q) + 1), to_ivec3(block_grid(last)));
  }
  /// The same of eight positions at once, bit i of the i-th.
  uint32_t operator()(const Int8& level, const Float8& x, const Float8& y, const Float8& z) const {
    const Float8 scale = reinterpret_cast<Float8>((127 - level) << 23);
    Int8 cell[3], grid[3];
    const Float8* p[3] = {&x, &y, &z};
    for (int axis = 0; axis < 3; ++axis) {
      const Int8 last = (Int8{} + last_[axis]) >> level;
      const Float8 high = __builtin_convertvector(last, Float8);
      Float8 q = *p[axis] * scale - 0.5f;
      q = q > -1.0f ? q : Float8{} - 1.0f;
      q = q < high ? q : high;
      const Int8 i = __builtin_convertvector(q, Int8);
      cell[axis] = i + (__builtin_convertvector(i, Float8) > q) + 1;  // true is -1
      grid[axis] = ((last + 1) >> 3) + 1;
    }
    const Int8 block = (cell[0] >> 3) + grid[0] * ((cell[1] >> 3) + grid[1] * (cell[2] >> 3));
    const Int8 slice = cell[2] & 7, in_slice = (cell[0] & 7) + 8 * (cell[1] & 7);
    uint32_t found = 0;
    for (int i = 0; i < 8; ++i) {
      const Block& bits = blocks_[slots_[size_t(first_[size_t(level[i])]) + size_t(block[i])]];
      found |= uint32_t(bits[size_t(slice[i])] >> in_slice[i] & 1u) << i;
    }
    return found;
  }

  /// A stretch of a straight way on which look-ups find nothing.
  struct Gap {
    float length = 0.0f;  ///< from where it begins
    int level = 0;        ///< coarsest level of which that is true; it is of all finer ones
  };
  /// The stretch from p on, where `level` is empty. @param way voxels per unit of length @param inverse 1 / way
  Gap gap(int level, const Float4& p, const Float4& way, const Float4& inverse) const;

  int top() const { return static_cast<int>(first_.size()) - 1; }  ///< coarsest level

  size_t bytes() const { return slots_.capacity() * sizeof(uint32_t) + blocks_.capacity() * sizeof(Block); }

 private:
  using Block = BitBlocks::Block;
  static float scale(int level) { return 1.0f / static_cast<float>(1u << level); }
  /// Blocks along each axis: one more cell than texels. @param last texel of the level
  static Int4 block_grid(const Int4& last) { return ((last + 1) >> 3) + 1; }
  bool bit(int level, const glm::ivec3& cell, const glm::ivec3& grid) const {
    const int block = cell.x / 8 + grid.x * (cell.y / 8 + grid.y * (cell.z / 8));
    const Block& bits = blocks_[slots_[size_t(first_[size_t(level)]) + size_t(block)]];
    return bits[size_t(cell.z & 7)] >> ((cell.x & 7) + 8 * (cell.y & 7)) & 1u;
  }
  /// Without levels. @param size texels of the base
  explicit Occupancy(const glm::ivec3& size) : last_(to_int4(size) - 1), blocks_(1) {}
  void mark_cells_around(const std::vector<BitBlocks>& texels);

  // All levels in one table, so that look-ups in different ones can go side by side.
  Int4 last_{};                  // texel of the base along each axis; that of level k is last_ >> k
  std::vector<int32_t> first_;   // slot of each level
  std::vector<uint32_t> slots_;  // of each block, x fastest, then y, then z; 0: it is empty
  std::vector<Block> blocks_;    // the first one holds no bits
};

}  // namespace voxref
