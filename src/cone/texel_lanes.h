#pragma once
#include <array>
#include <cstdint>

#include "cone/corners.h"

namespace voxref {

/// Where eight look-ups of their own levels find their texels, worked out side by side: beside the texels' arithmetic
/// it is as much work again when done one by one.
struct TexelLanes {
  static constexpr size_t lanes = 8;
  template <class T>
  using Lanes = std::array<T, lanes>;

  alignas(32) Lanes<int32_t> brick;                ///< that the lowest of the eight corners is in, in the level's table
  alignas(32) Lanes<int32_t> texel;                ///< of that corner, in the brick
  alignas(32) Lanes<int32_t> inner;                ///< not 0: all eight are in the brick
  alignas(32) std::array<Lanes<float>, 8> shares;  ///< of each corner
};

/// One lane's shares.
struct LaneShares {
  const TexelLanes& at;
  size_t lane;
  float operator[](size_t corner) const { return at.shares[corner][lane]; }
};

/// Of volumes whose border texels go on for ever. @param last texel of the base along each axis; level k has that many
/// shifted right by k @param level 0 is the base @param x, y, z finite; voxels @param whole of the eight shares
inline void locate_clamped(const Int4& last, const Int8& level, const Float8& x, const Float8& y, const Float8& z,
                           const Float8& whole, TexelLanes& at) {
  const Float8 scale = reinterpret_cast<Float8>((127 - level) << 23);
  const Float8* p[3] = {&x, &y, &z};
  Int8 low[3], grid[3];
  Float8 f[3], g[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Int8 end = (Int8{} + last[axis]) >> level;
    const Float8 high = __builtin_convertvector(end, Float8);
    Float8 q = *p[axis] * scale - 0.5f;
    q = q > 0.0f ? q : Float8{};
    q = q < high ? q : high;
    const Int8 below = __builtin_convertvector(q, Int8);
    // At the end the next texel, which does not exist, would count nothing: the one before does so as well. Along an
    // axis of one texel the next lies outside of the volume, but in the same brick.
    low[axis] = below + ((below == end) & (end > 0));  // true is -1
    f[axis] = q - __builtin_convertvector(low[axis], Float8);
    g[axis] = 1.0f - f[axis];
    grid[axis] = (end >> 3) + 1;
  }
  const Int8 brick = (low[0] >> 3) + grid[0] * ((low[1] >> 3) + grid[1] * (low[2] >> 3));
  const Int8 in_x = low[0] & 7, in_y = low[1] & 7, in_z = low[2] & 7, texel = in_x + 8 * in_y + 64 * in_z;
  const Int8 inner = (in_x != 7) & (in_y != 7) & (in_z != 7);
  std::memcpy(at.brick.data(), &brick, sizeof brick);
  std::memcpy(at.texel.data(), &texel, sizeof texel);
  std::memcpy(at.inner.data(), &inner, sizeof inner);
  f[2] *= whole, g[2] *= whole;
  for (size_t row = 0; row < 4; ++row) {
    const Float8 share = (row & 1 ? f[1] : g[1]) * (row & 2 ? f[2] : g[2]);
    const Float8 at_low = share * g[0], at_high = share * f[0];
    std::memcpy(at.shares[2 * row].data(), &at_low, sizeof at_low);
    std::memcpy(at.shares[2 * row + 1].data(), &at_high, sizeof at_high);
  }
}

/// Calls visit(corners, shares) for one lane, or returns {} where nothing is stored. @param volume of the lane's level
template <class Texel, class Visit>
inline auto visit_lane(const BrickVolume<Texel>& volume, const TexelLanes& at, size_t lane, const Visit& visit) {
  return visit_corners(volume, size_t(at.brick[lane]), size_t(at.texel[lane]), at.inner[lane] != 0,
                       [&](const auto& corners) {
                         return visit(corners, LaneShares{at, lane});
                       });
}

}  // namespace voxref
