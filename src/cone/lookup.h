#pragma once
#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "cone/float4.h"
#include "cone/medium.h"

namespace voxref {

/// What one direction of travel needs of a directional texel: the three faces that it meets, by the share |d_a| / |d|_1
/// of the texel's silhouette that each makes up. So weighted, a wall is as opaque at grazing incidence as it is face
/// on: its extinction falls with |cos| while the way through it grows with 1 / |cos|. The weights d_a^2 of the
/// published shaders, which also sum to 1, let exp(-9.2 |cos|) of the light through: 2.4 % of a wall's hemisphere.
class DirectionalRead {
 public:
  explicit DirectionalRead(const glm::vec3& direction) {
    const glm::vec3 silhouette = glm::abs(direction);
    const float sum = silhouette.x + silhouette.y + silhouette.z;
    for (int axis = 0; axis < 3; ++axis) {
      faces_[size_t(axis)] = size_t(2 * axis + (direction[axis] >= 0.0f));  // Face: negative before positive, x y z
      weights_[size_t(axis)] = silhouette[axis] / sum;
    }
  }
  Float4 operator()(const DirectionalTexel& texel) const {
    return weights_[0] * load(texel[faces_[0]]) + weights_[1] * load(texel[faces_[1]]) +
           weights_[2] * load(texel[faces_[2]]);
  }
  Float4 operator()(const glm::vec4& texel) const { return load(texel); }

 private:
  std::array<size_t, 3> faces_;
  std::array<float, 3> weights_;
};

/// Largest integer not above x, for |x| < 2^31. std::floor is a library call where SSE4.1 is not assumed.
inline int floor_to_int(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x);
}

/// Trilinear look-up. @param p in texels, centres at half-integers; texels outside the volume are empty
template <class Texel>
Float4 trilinear(const BrickVolume<Texel>& volume, const glm::vec3& p, const DirectionalRead& read) {
  using Volume = BrickVolume<Texel>;
  constexpr int side = Volume::side, last = side - 1;
  const glm::ivec3 v(floor_to_int(p.x - 0.5f), floor_to_int(p.y - 0.5f), floor_to_int(p.z - 0.5f));
  const glm::vec3 f = p - 0.5f - glm::vec3(v);

  const auto blend = [&f](const Float4& c000, const Float4& c100, const Float4& c010, const Float4& c110,
                          const Float4& c001, const Float4& c101, const Float4& c011, const Float4& c111) {
    return mix(mix(mix(c000, c100, f.x), mix(c010, c110, f.x), f.y),
               mix(mix(c001, c101, f.x), mix(c011, c111, f.x), f.y), f.z);
  };
  // Two look-ups of three have all eight corners in one brick, and most of those find that it is absent.
  const bool one_brick = (v.x & last) != last && (v.y & last) != last && (v.z & last) != last;
  if (one_brick && volume.contains(v)) {
    const uint32_t slot = volume.slot({v.x / side, v.y / side, v.z / side});
    if (slot == Volume::absent) return Float4{};
    const Texel* t = volume.brick(slot).data() + Volume::offset(v);
    constexpr int y = side, z = side * side;
    return blend(read(t[0]), read(t[1]), read(t[y]), read(t[y + 1]), read(t[z]), read(t[z + 1]), read(t[z + y]),
                 read(t[z + y + 1]));
  }
  const auto corner = [&](int x, int y, int z) { return read(volume(v + glm::ivec3(x, y, z))); };
  return blend(corner(0, 0, 0), corner(1, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(0, 0, 1), corner(1, 0, 1),
               corner(0, 1, 1), corner(1, 1, 1));
}

/// Quadrilinear look-up: trilinear in space, linear between the two levels around `level`.
/// @param p in voxels of the base volume @param level in [0, medium.top()]
inline Float4 quadrilinear(const Medium& medium, const glm::vec3& p, float level, const DirectionalRead& read) {
  const auto at = [&](int k) {
    return k == 0 ? trilinear(medium.texels.base, p, read)
                  : trilinear(medium.texels.levels[static_cast<size_t>(k - 1)], p * (1.0f / Medium::cell(k)), read);
  };
  const int lower = static_cast<int>(level);
  const float f = level - static_cast<float>(lower);
  return f == 0.0f ? at(lower) : mix(at(lower), at(lower + 1), f);
}

}  // namespace voxref
