#pragma once
#include <array>
#include <glm/vec3.hpp>

#include "voxel/brick_volume.h"
#include "voxel/floor.h"

namespace voxref {

/// The eight texels around a position, x fastest, then y, then z, and where between them it lies.
template <class Texel>
struct Corners {
  std::array<const Texel*, 8> texels;
  Float4 f;    ///< x, y, z in [0,1]
  bool empty;  ///< nothing is stored there: do not look at the texels
};

/// The eight at which each coordinate is that of `low`, or is greater by `step`, all of which lie in the volume.
/// @param step 0 or 1 along each axis
template <class Texel>
void find_corners(const BrickVolume<Texel>& volume, const glm::ivec3& low, const glm::ivec3& step,
                  Corners<Texel>& corners) {
  using Volume = BrickVolume<Texel>;
  constexpr int side = Volume::side, in_brick = side - 1;
  static const Texel nothing{};
  const glm::ivec3& bricks = volume.brick_grid();
  const uint32_t* slots =
      volume.slots() + (low.x / side + size_t(bricks.x) * (size_t(low.y / side) + size_t(bricks.y) * (low.z / side)));
  const glm::ivec3 inside(low.x & in_brick, low.y & in_brick, low.z & in_brick);
  const glm::ivec3 next = inside + step;
  corners.empty = false;
  if (((next.x | next.y | next.z) & side) == 0) {  // two look-ups of three have all eight in one brick
    corners.empty = *slots == Volume::absent;
    if (corners.empty) return;
    const Texel* t = volume.data() + *slots * Volume::texels_per_brick + inside.x + side * (inside.y + side * inside.z);
    const int x = step.x, y = side * step.y, z = side * side * step.z;
    corners.texels = {t, t + x, t + y, t + y + x, t + z, t + z + x, t + z + y, t + z + y + x};
    return;
  }
  // Of each axis the offsets of the low and the high coordinate, among the slots and in the brick.
  const size_t slot_x[2] = {0, size_t(next.x >> 3)}, in_x[2] = {size_t(inside.x), size_t(next.x & in_brick)};
  const size_t slot_y[2] = {0, size_t(next.y >> 3) * size_t(bricks.x)};
  const size_t in_y[2] = {size_t(side * inside.y), size_t(side * (next.y & in_brick))};
  const size_t slot_z[2] = {0, size_t(next.z >> 3) * size_t(bricks.x) * size_t(bricks.y)};
  const size_t in_z[2] = {size_t(side * side * inside.z), size_t(side * side * (next.z & in_brick))};
  for (size_t i = 0; i < 8; ++i) {
    const size_t x = i & 1, y = i >> 1 & 1, z = i >> 2;
    const uint32_t slot = slots[slot_x[x] + slot_y[y] + slot_z[z]];
    corners.texels[i] = slot == Volume::absent
                            ? &nothing
                            : volume.data() + slot * Volume::texels_per_brick + in_x[x] + in_y[y] + in_z[z];
  }
}

/// Of a volume whose border texels go on for ever. @param p finite; in texels, centres at half-integers
template <class Texel>
Corners<Texel> corners_clamped(const BrickVolume<Texel>& volume, const Float4& p) {
  // Beyond the outermost centres the weight of the next texel, which does not exist, is 0.
  const Int4 last = to_int4(volume.size()) - 1;
  const Float4 q = clamp(p - 0.5f, Float4{}, to_float4(last));
  const Int4 low = truncated(q);
  Corners<Texel> corners;
  corners.f = q - to_float4(low);
  find_corners(volume, to_ivec3(low), to_ivec3((low < last) & 1), corners);
  return corners;
}

/// Of a volume that is empty outside of its border.
template <class Texel>
Corners<Texel> corners_within(const BrickVolume<Texel>& volume, const Float4& p) {
  const Float4 q = p - 0.5f;
  const Int4 low = floor_to_int(q);
  const glm::ivec3 v = to_ivec3(low);
  Corners<Texel> corners;
  corners.f = q - to_float4(low);
  if (volume.contains(v) && volume.contains(v + 1)) {
    find_corners(volume, v, glm::ivec3(1), corners);
    return corners;
  }
  corners.empty = false;
  for (int i = 0; i < 8; ++i) corners.texels[size_t(i)] = &volume(v + glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
  return corners;
}

}  // namespace voxref
