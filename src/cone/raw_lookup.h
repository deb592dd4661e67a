#pragma once
#include <algorithm>
#include <array>
#include <glm/vec3.hpp>

#include "cone/float4.h"
#include "cone/raw_march.h"
#include "voxel/texel.h"

namespace voxref {

/// What one direction of travel reads of a directional texel: three faces, by the squares of its components (spec
/// section 5). They sum to 1.
class SquaredRead {
 public:
  explicit SquaredRead(const glm::vec3& direction) {
    for (int axis = 0; axis < 3; ++axis) {
      faces_[size_t(axis)] = size_t(2 * axis + !(direction[axis] < 0.0f));  // Face: negative before positive, x y z
      const float weight = direction[axis] * direction[axis];
      weights_[size_t(axis)] = Float4{weight, weight, weight, weight};
    }
  }
  template <class Texel>
  Float4 operator()(const Directional<Texel>& texel) const {
    return weights_[0] * decode(texel[faces_[0]]) + weights_[1] * decode(texel[faces_[1]]) +
           weights_[2] * decode(texel[faces_[2]]);
  }
  template <class Texel>
  Float4 operator()(const Texel& texel) const {
    return decode(texel);
  }

 private:
  std::array<size_t, 3> faces_;
  std::array<Float4, 3> weights_;
};

/// Trilinear look-up of a volume whose border texels go on for ever.
/// @param p finite; in texels, centres at half-integers
template <class Texel, class Read>
Float4 trilinear_clamped(const BrickVolume<Texel>& volume, const glm::vec3& p, const Read& read) {
  using Volume = BrickVolume<Texel>;
  constexpr int side = Volume::side, last = side - 1;
  // Beyond the outermost centres the weight of the next texel, which does not exist, is 0.
  const glm::vec3 q = glm::clamp(p - 0.5f, glm::vec3(0.0f), glm::vec3(volume.size() - 1));
  const glm::ivec3 v(q);
  const glm::vec3 f = q - glm::vec3(v);
  const auto blend = [&f](const Float4& c000, const Float4& c100, const Float4& c010, const Float4& c110,
                          const Float4& c001, const Float4& c101, const Float4& c011, const Float4& c111) {
    return mix(mix(mix(c000, c100, f.x), mix(c010, c110, f.x), f.y),
               mix(mix(c001, c101, f.x), mix(c011, c111, f.x), f.y), f.z);
  };
  if ((v.x & last) != last && (v.y & last) != last && (v.z & last) != last) {  // all eight in one brick
    const uint32_t slot = volume.slot(v / side);
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
