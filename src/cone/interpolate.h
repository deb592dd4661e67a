#pragma once
#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "cone/corners.h"
#include "cone/optical_texel.h"
#include "voxel/float4.h"

namespace voxref {

/// What one direction of travel reads of a directional texel: three faces, and their weights, which sum to 1.
struct FaceRead {
  /// @param shares of the axes
  FaceRead(const glm::vec3& direction, const glm::vec3& shares) {
    for (int axis = 0; axis < 3; ++axis) {
      faces[size_t(axis)] = 2 * size_t(axis) + !(direction[axis] < 0.0f);  // Face: negative before positive, x y z
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

/// What each of the eight corners around a position counts for. @param f x, y, z in [0,1]: where between them it lies
inline std::array<float, 8> corner_shares(const Float4& f) {
  const Float4 g = 1.0f - f;
  const Float4 rows = Float4{g[1], f[1], g[1], f[1]} * Float4{g[2], g[2], f[2], f[2]};
  const Float4 low = rows * g[0], high = rows * f[0];
  return {low[0], high[0], low[1], high[1], low[2], high[2], low[3], high[3]};
}

/// A sum of look-ups of one direction of travel in volumes of directional texels.
template <class Kernel, class Read>
class LookupSum {
 public:
  explicit LookupSum(const Read& read) : read_(read) {}

  /// @param corners Corners or BrickCorners @param shares of the eight
  template <class SomeCorners, class Shares>
  void add(const SomeCorners& corners, const Shares& shares) {
    total_ += Kernel::interpolate(corners, shares, read_);
  }
  Float4 total() const { return total_; }

 private:
  const Read& read_;
  Float4 total_{};
};

/// The value between corners, which are Corners or BrickCorners. @param shares of the eight corners, summing to 1
struct PlainKernel {
  template <class SomeCorners, class Shares, class Read>
  static Float4 interpolate(const SomeCorners& corners, const Shares& shares, const Read& read) {
    Float4 sum{};
    for (size_t i = 0; i < 8; ++i) sum += shares[i] * value(corners[i], read);
    return sum;
  }

  /// What sums look-ups in volumes of Directional<Texel>.
  template <class Texel, class Read>
  using Sum = LookupSum<PlainKernel, Read>;

 private:
  /// Of a texel that looks the same from everywhere,
  template <class Texel, class Read>
  static Float4 value(const Texel& texel, const Read&) {
    return Read::value(texel);
  }
  /// and of a directional one.
  template <class Texel, class Read>
  static Float4 value(const Directional<Texel>& texel, const Read& read) {
    return read.weights[0] * Read::value(texel[read.faces[0]]) + read.weights[1] * Read::value(texel[read.faces[1]]) +
           read.weights[2] * Read::value(texel[read.faces[2]]);
  }
};

}  // namespace voxref
