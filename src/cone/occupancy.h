#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "voxel/floor.h"
#include "voxel/mipmap.h"

namespace voxref {

/// One bit for each texel of a volume, or for each cell between texels, in blocks of 8^3; blocks without a bit that is
/// set take no memory but their table entry.
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
  /// @param v in the size
  bool operator()(const glm::ivec3& v) const {
    constexpr int in_block = side - 1;
    const uint32_t slot = slots_[index({v.x / side, v.y / side, v.z / side})];
    return slot != absent && (bits_[slot][size_t(v.z & in_block)] >> ((v.x & in_block) + side * (v.y & in_block)) & 1u);
  }
  /// Block of the given block coordinates, null where it has no bits.
  const Block* find(const glm::ivec3& block) const {
    const uint32_t slot = slots_[index(block)];
    return slot == absent ? nullptr : &bits_[slot];
  }
  /// Sets bits of a slice of a block. Those outside of the block table are dropped.
  void set(const glm::ivec3& block, int z, uint64_t bits);
  void shrink_to_fit() { bits_.shrink_to_fit(); }
  size_t bytes() const { return slots_.capacity() * sizeof(uint32_t) + bits_.capacity() * sizeof(Block); }

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
    const Level& l = levels_[static_cast<size_t>(level)];
    return l.cells(to_ivec3(floor_to_int(clamp(p * scale(level) - 0.5f, Float4{} - 1.0f, l.last)) + 1));
  }

  /// A stretch of a straight way on which look-ups find nothing.
  struct Gap {
    float length = 0.0f;  ///< from where it begins
    int level = 0;        ///< coarsest level of which that is true; it is of all finer ones
  };
  /// The stretch from p on, where `level` is empty. @param way voxels per unit of length @param inverse 1 / way
  Gap gap(int level, const Float4& p, const Float4& way, const Float4& inverse) const;

  size_t bytes() const;

 private:
  struct Level {
    Float4 last{};  ///< texel along each axis
    BitBlocks cells;
  };
  static float scale(int level) { return 1.0f / static_cast<float>(1u << level); }
  int top() const { return static_cast<int>(levels_.size()) - 1; }
  /// @param size texels
  void add_level(const BitBlocks& texels, const glm::ivec3& size);

  std::vector<Level> levels_;
};

}  // namespace voxref
