#include "cone/occupancy.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace voxref {
namespace {

constexpr int side = BitBlocks::side;
static_assert(side == BrickVolume<char>::side, "blocks of texels' bits are those of their bricks");

glm::ivec3 block_at(const glm::ivec3& grid, int index) {
  return {index % grid.x, index / grid.x % grid.y, index / grid.x / grid.y};
}
int count(const glm::ivec3& grid) { return grid.x * grid.y * grid.z; }

/// Calls visit(block coordinates, block) for all that have bits.
template <class Visit>
void for_each_block(const BitBlocks& bits, Visit&& visit) {
  for (int i = 0; i < count(bits.block_grid()); ++i) {
    const glm::ivec3 at = block_at(bits.block_grid(), i);
    if (const BitBlocks::Block* block = bits.find(at)) visit(at, *block);
  }
}

/// Whether any bit is set in some texels: this asks none for its channels.
template <size_t count, class Texel>
bool any_holds(const Texel* texels) {
  static_assert(sizeof(Texel) % sizeof(uint32_t) == 0);
  std::array<uint32_t, count * sizeof(Texel) / sizeof(uint32_t)> words;
  std::memcpy(words.data(), texels, sizeof words);
  uint32_t any = 0;
  for (const uint32_t word : words) any |= word;
  return any != 0;
}

/// Adds the texels that hold something. Most rows of a brick are empty.
template <class Texel>
void add_texels(const BrickVolume<Texel>& volume, BitBlocks& texels) {
  for (int i = 0; i < count(volume.brick_grid()); ++i) {
    const glm::ivec3 at = block_at(volume.brick_grid(), i);
    const uint32_t slot = volume.slot(at);
    if (slot == volume.absent) continue;
    const Texel* row = volume.brick(slot).data();
    for (int z = 0; z < side; ++z) {
      uint64_t slice = 0;
      for (int y = 0; y < side; ++y, row += side) {
        if (!any_holds<side>(row)) continue;
        for (int x = 0; x < side; ++x) slice |= uint64_t{any_holds<1>(row + x)} << (x + side * y);
      }
      texels.set(at, z, slice);
    }
  }
}

/// Texels of the next level that have any of these inside.
void add_parents(const BitBlocks& fine, BitBlocks& coarse) {
  constexpr uint64_t two_by_two = 0x0303;
  for_each_block(fine, [&](const glm::ivec3& at, const BitBlocks::Block& block) {
    const glm::ivec3 corner = at % 2 * (side / 2);  // of the eighth of the coarse block that the fine one fills
    for (int z = 0; z < side; z += 2) {
      const uint64_t both = block[size_t(z)] | block[size_t(z) + 1];
      uint64_t slice = 0;
      for (int y = 0; y < side; y += 2)
        for (int x = 0; x < side; x += 2)
          slice |= uint64_t{(both >> (x + side * y) & two_by_two) != 0}
                   << (corner.x + x / 2 + side * (corner.y + y / 2));
      coarse.set(at / 2, corner.z + z / 2, slice);
    }
  });
}

/// Calls visit(block coordinates, z, slice) for what the cells that touch a texel set of a slice of their blocks: those
/// of the texel's own index and of the next along each axis.
template <class Visit>
void for_each_slice_of_cells(const BitBlocks& texels, Visit&& visit) {
  constexpr uint64_t not_first_column = 0xfefefefefefefefe, first_column = 0x0101010101010101;
  const auto rows = [&](const glm::ivec3& block, int z, uint64_t slice) {
    visit(block, z, slice | slice << side);
    visit(block + glm::ivec3(0, 1, 0), z, slice >> (side * (side - 1)));
  };
  const auto whole_slice = [&](const glm::ivec3& block, int z, uint64_t slice) {
    rows(block, z, slice | (slice << 1 & not_first_column));
    rows(block + glm::ivec3(1, 0, 0), z, slice >> (side - 1) & first_column);
  };
  for_each_block(texels, [&](const glm::ivec3& at, const BitBlocks::Block& block) {
    for (int z = 0; z < side; ++z) whole_slice(at, z, block[size_t(z)] | (z > 0 ? block[size_t(z) - 1] : 0));
    whole_slice(at + glm::ivec3(0, 0, 1), 0, block[side - 1]);
  });
}

}  // namespace

void BitBlocks::set(const glm::ivec3& block, int z, uint64_t bits) {
  if (bits == 0) return;
  uint32_t& slot = slots_[index(block)];
  if (slot == absent) {
    slot = uint32_t(bits_.size());
    bits_.emplace_back();
  }
  bits_[slot][size_t(z)] |= bits;
}

/// Twice over the texels, first for where there are blocks: so they are allocated once. @param texels of all levels
void Occupancy::mark_cells_around(const std::vector<BitBlocks>& texels) {
  std::vector<glm::ivec3> grids;
  for (size_t level = 0; level < texels.size(); ++level) {
    first_.push_back(level == 0 ? 0 : first_.back() + count(grids.back()));
    grids.push_back(to_ivec3(block_grid(last_ >> int(level))));
  }
  slots_.assign(size_t(first_.back() + count(grids.back())), 0);
  const auto for_each_slice = [&](auto&& visit) {
    for (size_t level = 0; level < texels.size(); ++level) {
      const glm::ivec3& grid = grids[level];
      for_each_slice_of_cells(texels[level], [&](const glm::ivec3& at, int z, uint64_t slice) {
        if (slice != 0) visit(slots_[size_t(first_[level] + at.x + grid.x * (at.y + grid.y * at.z))], z, slice);
      });
    }
  };
  for_each_slice([](uint32_t& slot, int, uint64_t) { slot = 1; });
  uint32_t blocks = 1;
  for (uint32_t& slot : slots_)
    if (slot != 0) slot = blocks++;
  blocks_.resize(blocks);
  for_each_slice([&](uint32_t slot, int z, uint64_t slice) { blocks_[slot][size_t(z)] |= slice; });
}

template <class Texel>
Occupancy::Occupancy(const BasicPyramid<Texel>& pyramid) : Occupancy(pyramid.base.size()) {
  std::vector<BitBlocks> texels;
  texels.reserve(pyramid.levels.size() + 1);
  texels.emplace_back(pyramid.base.size()).reserve(pyramid.base.brick_count());
  add_texels(pyramid.base, texels.back());
  for (const BrickVolume<Directional<Texel>>& level : pyramid.levels) {
    BitBlocks& coarse = texels.emplace_back(level.size());
    coarse.reserve(level.brick_count());
    add_parents(texels[texels.size() - 2], coarse);
    add_texels(level, coarse);  // volumes that somebody else made may hold more than their parents do
  }
  mark_cells_around(texels);
}

Occupancy::Occupancy(const SurfaceGrid& surfaces) : Occupancy(surfaces.grid.size) {
  glm::ivec3 size = surfaces.grid.size;
  std::vector<BitBlocks> texels(1, BitBlocks(size));
  for (const glm::ivec3& v : surfaces.voxels)
    texels.back().set(v / side, v.z % side, uint64_t{1} << (v.x % side + side * (v.y % side)));
  while (size != glm::ivec3(1)) {
    size = (size + 1) / 2;
    BitBlocks coarse(size);
    add_parents(texels.back(), coarse);
    texels.push_back(std::move(coarse));
  }
  mark_cells_around(texels);
}

Occupancy::Gap Occupancy::gap(int level, const Float4& p, const Float4& way, const Float4& inverse) const {
  while (level < top() && !(*this)(level + 1, p)) ++level;
  constexpr float margin = 1e-3f;  // texels: rounding shall not carry a look-up into the next cell
  const Float4 at = p * scale(level) - 0.5f;
  const Float4 to_face =
      (way > 0.0f ? Float4{} + (1.0f - margin) : Float4{} + margin) - (at - to_float4(floor_to_int(at)));
  const Float4 lengths = way == 0.0f ? Float4{} + std::numeric_limits<float>::infinity() : to_face * inverse;
  const float shortest = std::min(std::min(lengths[0], lengths[1]), lengths[2]);
  return {std::max(shortest, 0.0f) / scale(level), level};
}

template Occupancy::Occupancy(const BasicPyramid<glm::vec4>&);
template Occupancy::Occupancy(const BasicPyramid<Rgba16f>&);
template Occupancy::Occupancy(const BasicPyramid<Rgba8>&);

}  // namespace voxref
