#pragma once
#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "cone/float4.h"
#include "cone/raw_march.h"
#include "voxel/texel.h"

namespace voxref {

/// What one direction of travel reads of a directional texel: three faces, by the squares of its components (spec
/// section 5). They sum to 1.
struct SquaredRead {
  explicit SquaredRead(const glm::vec3& direction) {
    for (int axis = 0; axis < 3; ++axis) {
      faces[size_t(axis)] = size_t(2 * axis + !(direction[axis] < 0.0f));  // Face: negative before positive, x y z
      weights[size_t(axis)] = direction[axis] * direction[axis];
    }
  }
  template <class Texel>
  Float4 operator()(const Directional<Texel>& texel) const {
    return weights[0] * decode(texel[faces[0]]) + weights[1] * decode(texel[faces[1]]) +
           weights[2] * decode(texel[faces[2]]);
  }
  template <class Texel>
  Float4 operator()(const Texel& texel) const {
    return decode(texel);
  }

  std::array<size_t, 3> faces{};
  std::array<float, 3> weights{};
};

/// The eight texels around a position, x fastest, then y, then z, and where between them it lies.
template <class Texel>
struct Corners {
  std::array<const Texel*, 8> texels;
  glm::vec3 f;  ///< in [0,1]
  bool empty;   ///< nothing is stored there: do not look at the texels
};

/// Finds them in a volume whose border texels go on for ever. @param p finite; in texels, centres at half-integers
template <class Texel>
Corners<Texel> corners_around(const BrickVolume<Texel>& volume, const glm::vec3& p) {
  using Volume = BrickVolume<Texel>;
  constexpr int side = Volume::side, last = side - 1;
  static const Texel nothing{};
  // Beyond the outermost centres the weight of the next texel, which does not exist, is 0.
  const glm::vec3 q = glm::clamp(p - 0.5f, glm::vec3(0.0f), glm::vec3(volume.size() - 1));
  const glm::ivec3 v(q);
  Corners<Texel> corners;
  corners.f = q - glm::vec3(v);
  corners.empty = false;
  if ((v.x & last) != last && (v.y & last) != last && (v.z & last) != last) {  // all eight in one brick
    const uint32_t slot = volume.slot({v.x / side, v.y / side, v.z / side});
    corners.empty = slot == Volume::absent;
    if (corners.empty) return corners;
    const Texel* t = volume.brick(slot).data() + Volume::offset(v);
    constexpr int y = side, z = side * side;
    corners.texels = {t, t + 1, t + y, t + y + 1, t + z, t + z + 1, t + z + y, t + z + y + 1};
    return corners;
  }
  const glm::ivec3 next = glm::min(v + 1, volume.size() - 1);
  for (size_t i = 0; i < 8; ++i) {
    const glm::ivec3 c(i & 1 ? next.x : v.x, i & 2 ? next.y : v.y, i & 4 ? next.z : v.z);
    const uint32_t slot = volume.slot({c.x / side, c.y / side, c.z / side});
    corners.texels[i] = slot == Volume::absent ? &nothing : volume.brick(slot).data() + Volume::offset(c);
  }
  return corners;
}

/// Mixes eight corners; f as in Corners.
template <class T>
T mix_corners(const std::array<T, 8>& c, const glm::vec3& f) {
  const auto mixed = [](const T& a, const T& b, float t) { return a + t * (b - a); };
  return mixed(mixed(mixed(c[0], c[1], f.x), mixed(c[2], c[3], f.x), f.y),
               mixed(mixed(c[4], c[5], f.x), mixed(c[6], c[7], f.x), f.y), f.z);
}

template <class Texel, class Read>
Float4 interpolate(const Corners<Texel>& corners, const Read& read) {
  std::array<Float4, 8> values;
  for (size_t i = 0; i < 8; ++i) values[i] = read(*corners.texels[i]);
  return mix_corners(values, corners.f);
}

/// The same for directional bytes, which most of a cone's time goes into: with AVX2 two texels at a time, where the
/// machine has it; the results differ by rounding.
Float4 interpolate(const Corners<Directional<Rgba8>>& corners, const SquaredRead& read);

/// Trilinear look-up, 0 where nothing is stored.
template <class Texel, class Read>
Float4 trilinear_clamped(const BrickVolume<Texel>& volume, const glm::vec3& p, const Read& read) {
  const Corners<Texel> corners = corners_around(volume, p);
  return corners.empty ? Float4{} : interpolate(corners, read);
}

/// A cone's sample. @param p in voxels of the base volume
template <class Texel>
Float4 sample_raw(const BasicPyramid<Texel>& pyramid, const glm::vec3& p, const ConeStep& step,
                  const SquaredRead& read) {
  const auto at = [&](int level) {
    if (level == 0) return trilinear_clamped(pyramid.base, p, read);
    return trilinear_clamped(pyramid.levels[size_t(level - 1)], p * (1.0f / float(1u << level)), read);
  };
  const Float4 fine = at(step.level);
  return step.fraction == 0.0f ? fine : mix(fine, at(step.level + 1), step.fraction);
}

}  // namespace voxref
