#pragma once
#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "cone/corners.h"
#include "cone/float4.h"
#include "cone/optical_texel.h"

namespace voxref {

/// What one direction of travel reads of a directional texel: three faces, and their weights, which sum to 1.
struct FaceRead {
  /// @param shares of the axes
  FaceRead(const glm::vec3& direction, const glm::vec3& shares) {
    for (int axis = 0; axis < 3; ++axis) {
      faces[size_t(axis)] = size_t(2 * axis + !(direction[axis] < 0.0f));  // Face: negative before positive, x y z
      weights[size_t(axis)] = shares[axis];
    }
  }
  std::array<size_t, 3> faces{};
  std::array<float, 3> weights{};
};

/// Reads premultiplied radiance and opacity; faces count with the squares of the direction's components, as the
/// published shaders have it (spec section 5).
struct SquaredRead : FaceRead {
  explicit SquaredRead(const glm::vec3& direction) : FaceRead(direction, direction * direction) {}
  template <class Texel>
  static Float4 value(const Texel& texel) {
    return decode(texel);
  }
};

/// Reads a medium's texels; faces count with the share |d_a| / |d|_1 of the texel's silhouette that each makes up. So
/// weighted, a wall is as opaque at grazing incidence as it is face on: its extinction falls with |cos| while the way
/// through it grows with 1 / |cos|. The published weights let exp(-9.2 |cos|) of the light through: 2.4 % of a wall's
/// hemisphere.
struct OpticalRead : FaceRead {
  explicit OpticalRead(const glm::vec3& direction)
      : FaceRead(direction,
                 glm::abs(direction) / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z))) {}
  template <class Texel>
  static Float4 value(const Texel& texel) {
    return optical(texel);
  }
};

/// Mixes eight corners; f as in Corners.
template <class T>
T mix_corners(const std::array<T, 8>& c, const Float4& f) {
  const auto mixed = [](const T& a, const T& b, float t) { return a + t * (b - a); };
  return mixed(mixed(mixed(c[0], c[1], f[0]), mixed(c[2], c[3], f[0]), f[1]),
               mixed(mixed(c[4], c[5], f[0]), mixed(c[6], c[7], f[0]), f[1]), f[2]);
}

/// The value between corners: of texels that look the same from everywhere,
template <class Texel, class Read>
Float4 interpolate(const Corners<Texel>& corners, const Read&) {
  std::array<Float4, 8> values;
  for (size_t i = 0; i < 8; ++i) values[i] = Read::value(*corners.texels[i]);
  return mix_corners(values, corners.f);
}
/// and of directional ones, plainly
template <class Texel, class Read>
Float4 interpolate_plainly(const Corners<Directional<Texel>>& corners, const Read& read) {
  std::array<Float4, 8> values;
  for (size_t i = 0; i < 8; ++i) {
    const Directional<Texel>& texel = *corners.texels[i];
    values[i] = read.weights[0] * Read::value(texel[read.faces[0]]) +
                read.weights[1] * Read::value(texel[read.faces[1]]) +
                read.weights[2] * Read::value(texel[read.faces[2]]);
  }
  return mix_corners(values, corners.f);
}
/// or, where the machine has AVX2, two texels at a time, since most of a cone's time goes into it: the results differ
/// by rounding.
template <class Texel, class Read>
Float4 interpolate(const Corners<Directional<Texel>>& corners, const Read& read);

}  // namespace voxref
