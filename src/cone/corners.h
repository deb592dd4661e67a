#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <utility>

#include "voxel/brick_volume.h"
#include "voxel/floor.h"

namespace voxref {

/// The eight texels around a position, x fastest, then y, then z.
template <class T>
struct Corners {
  using Texel = T;
  static constexpr bool rows_together = false;
  std::array<const Texel*, 8> texels;
  const Texel& operator[](size_t i) const { return *texels[i]; }
};

/// The same inside of one brick: the two of a row lie side by side.
template <class T>
struct BrickCorners {
  using Texel = T;
  static constexpr bool rows_together = true;
  const Texel* first;
  const Texel& operator[](size_t i) const {
    constexpr size_t side = BrickVolume<Texel>::side;
    return first[(i & 1) + side * (i >> 1 & 1) + side * side * (i >> 2)];
  }
};

/// Calls visit(corners) with the eight whose coordinates are those of the lowest or greater by 1, or returns {} where
/// nothing is stored around them. Two look-ups of three have all eight in one brick, and get BrickCorners.
/// @param brick that the lowest is in: index in the volume's table @param texel of the lowest, in the brick
/// @param inner whether the brick has all eight
template <class Texel, class Visit>
inline auto visit_corners(const BrickVolume<Texel>& volume, size_t brick, size_t texel, bool inner,
                          const Visit& visit) {
  using Volume = BrickVolume<Texel>;
  constexpr int side = Volume::side, in_brick = side - 1;
  using Result = decltype(visit(Corners<Texel>{}));
  const uint32_t* slots = volume.slots() + brick;
  if (inner) {
    if (*slots == Volume::absent) return Result();
    return visit(BrickCorners<Texel>{volume.data() + *slots * Volume::texels_per_brick + texel});
  }
  const glm::ivec3& bricks = volume.brick_grid();
  // Of each axis how much further the high coordinate is than the low one, among the slots and in the brick.
  static const Texel nothing{};
  const auto further = [](int coordinate, size_t slot_stride, int texel_stride) {
    return coordinate == in_brick ? std::pair(slot_stride, -in_brick * texel_stride)
                                  : std::pair(size_t{0}, texel_stride);
  };
  const auto [slot_x, in_x] = further(int(texel) & in_brick, 1, 1);
  const auto [slot_y, in_y] = further(int(texel) / side & in_brick, size_t(bricks.x), side);
  const auto [slot_z, in_z] = further(int(texel) / (side * side), size_t(bricks.x) * size_t(bricks.y), side * side);
  Corners<Texel> corners;
  for (size_t i = 0; i < 8; ++i) {
    const bool x = i & 1, y = i >> 1 & 1, z = i >> 2;
    const uint32_t slot = slots[(x ? slot_x : 0) + (y ? slot_y : 0) + (z ? slot_z : 0)];
    const size_t own = texel + size_t((x ? in_x : 0) + (y ? in_y : 0) + (z ? in_z : 0));
    corners.texels[i] = slot == Volume::absent ? &nothing : volume.data() + slot * Volume::texels_per_brick + own;
  }
  return visit(corners);
}

/// The same by the lowest's coordinates, which are in the volume, and greater ones too.
template <class Texel, class Visit>
inline auto visit_corners(const BrickVolume<Texel>& volume, const glm::ivec3& low, const Visit& visit) {
  constexpr int side = BrickVolume<Texel>::side, in_brick = side - 1;
  const glm::ivec3 &bricks = volume.brick_grid(), inside(low.x & in_brick, low.y & in_brick, low.z & in_brick);
  const size_t brick = low.x / side + size_t(bricks.x) * (size_t(low.y / side) + size_t(bricks.y) * (low.z / side));
  const bool inner = inside.x != in_brick && inside.y != in_brick && inside.z != in_brick;
  return visit_corners(volume, brick, BrickVolume<Texel>::offset(low), inner, visit);
}

/// Calls visit(corners, f) with those around p, where f, x, y, z in [0,1], is where between them p lies; or returns {}.
/// The volume is empty outside of its border. @param p in texels, centres at half-integers
template <class Texel, class Visit>
inline auto visit_corners_within(const BrickVolume<Texel>& volume, const Float4& p, const Visit& visit) {
  const Float4 q = p - 0.5f;
  const Int4 low = floor_to_int(q);
  const glm::ivec3 v = to_ivec3(low);
  const Float4 f = q - to_float4(low);
  const auto with_f = [&](const auto& corners) { return visit(corners, f); };
  if (volume.contains(v) && volume.contains(v + 1)) return visit_corners(volume, v, with_f);
  Corners<Texel> corners;
  for (int i = 0; i < 8; ++i) corners.texels[size_t(i)] = &volume(v + glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
  return with_f(corners);
}

}  // namespace voxref
