#include "cone/optical_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cone/optical_texel.h"
#include "parallel.h"

namespace voxref {
namespace {

const float most = -std::log(transparency_floor);

float opacity_of(float depth) {
  if (depth == 0.0f) return 0.0f;
  return depth >= most ? 1.0f - transparency_floor : -std::expm1(-depth);
}

/// Depths of the four columns of a texel along one axis.
using Columns = std::array<float, 4>;

Columns operator+(const Columns& a, const Columns& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}; }

float mean_depth(const Columns& columns) {
  float sum = 0.0f;
  for (const float depth : columns) sum += opacity_of(depth);
  return optical_depth(0.25f * sum);
}

/// The level below, as depths.
template <class Texel>
struct Base {
  const BrickVolume<Texel>& texels;
  float operator()(const glm::ivec3& v, int) const { return optical_depth(decode_alpha(texels(v))); }
};
struct Level {
  const BrickVolume<glm::vec3>& depths;
  float operator()(const glm::ivec3& v, int axis) const { return depths(v)[axis]; }
};

template <class Below>
Columns columns_of(const Below& below, const glm::ivec3& texel, int axis) {
  Columns columns{};
  const int p = (axis + 1) % 3, q = (axis + 2) % 3;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2);
    columns[static_cast<size_t>(corner[p] + 2 * corner[q])] += below(2 * texel + corner, axis);
  }
  return columns;
}

template <class Below>
float depth_along(const Below& below, const glm::ivec3& texel, int axis) {
  const Columns own = columns_of(below, texel, axis);
  const float alone = mean_depth(own);
  if (alone == 0.0f || alone >= most) return alone;
  float lacking = 0.0f;
  for (const int side : {-1, 1}) {
    glm::ivec3 next = texel;
    next[axis] += side;
    const Columns other = columns_of(below, next, axis);
    lacking += std::max(mean_depth(own + other) - alone - mean_depth(other), 0.0f);
  }
  return std::min(alone + 0.5f * lacking, most);
}

/// @param bricks those that the level's texels have
template <class Texel, class Below>
BrickVolume<glm::vec3> depths_of(const BrickVolume<Directional<Texel>>& level, const Below& below) {
  using Depths = BrickVolume<glm::vec3>;
  Depths result(level.size());
  const std::vector<glm::ivec3> bricks = level.bricks();
  result.allocate(bricks);
  parallel_for(bricks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b)
      for (int z = 0; z < Depths::side; ++z)
        for (int y = 0; y < Depths::side; ++y)
          for (int x = 0; x < Depths::side; ++x) {
            const glm::ivec3 texel = Depths::side * bricks[b] + glm::ivec3(x, y, z);
            if (level(texel) == Directional<Texel>{}) continue;  // without opacity it has no depth either
            for (int axis = 0; axis < 3; ++axis) result(texel)[axis] = depth_along(below, texel, axis);
          }
  });
  return result;
}

}  // namespace

template <class Texel>
std::vector<BrickVolume<glm::vec3>> optical_depths(const BasicPyramid<Texel>& pyramid) {
  std::vector<BrickVolume<glm::vec3>> depths;
  for (const BrickVolume<Directional<Texel>>& level : pyramid.levels)
    depths.push_back(depths.empty() ? depths_of(level, Base<Texel>{pyramid.base})
                                    : depths_of(level, Level{std::as_const(depths.back())}));
  return depths;
}

template std::vector<BrickVolume<glm::vec3>> optical_depths(const Pyramid&);
template std::vector<BrickVolume<glm::vec3>> optical_depths(const Pyramid16&);
template std::vector<BrickVolume<glm::vec3>> optical_depths(const Pyramid8&);

}  // namespace voxref
