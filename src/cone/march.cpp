#include "cone/march.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "cone/lookup.h"

namespace voxref {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Where less than this is left to be seen, the last sample's colour stands for it: a wall of one voxel is as opaque.
constexpr float opaque_transmittance = 1e-4f;

struct Interval {
  float begin, end;
};

/// The part of a ray inside the box [0, size], in multiples of `direction`; begin >= end: none.
Interval clip(const glm::vec3& origin, const glm::vec3& direction, const glm::vec3& size) {
  Interval inside{0.0f, infinity};
  for (int axis = 0; axis < 3; ++axis) {
    const float o = origin[axis], d = direction[axis];
    if (d == 0.0f) {
      if (o < 0.0f || o > size[axis]) return {0.0f, 0.0f};
      continue;
    }
    const float a = -o / d, b = (size[axis] - o) / d;
    inside.begin = std::max(inside.begin, std::min(a, b));
    inside.end = std::min(inside.end, std::max(a, b));
  }
  return inside;
}

/// Largest power of two not above x, for x >= 1: its float without the mantissa. Infinity stays.
float power_of_two_below(float x) { return std::bit_cast<float>(std::bit_cast<uint32_t>(x) & 0x7f800000u); }

/// Texels wider than 1/4 of the box's shortest side (but 1/16 of its longest: flat scenes) are not used: they stick out
/// of the scene or hold both sides of a room, and so are not opaque where the scene is. In closed cubes of 64 and 128
/// voxels six cones then return 0.980 at worst instead of 0.969. A lower limit returns more, but a wide cone is then
/// sampled along its axis only: at 1/16 the error on the Cornell box grows by half.
float coarsest_texel(const Medium& medium) {
  const glm::ivec3& size = medium.texels.grid.size;
  const float quarter = static_cast<float>(std::min({size.x, size.y, size.z})) / 4.0f;
  const float sixteenth = static_cast<float>(std::max({size.x, size.y, size.z})) / 16.0f;
  return std::min(Medium::cell(medium.top()), std::max({quarter, sixteenth, 1.0f}));
}

/// The way of a march: from the apex along the plane of the own surface until the line from the surface point has
/// risen to the same height, then along that line. Texels as wide as the cone blur by more than the lift, so that such
/// a cone keeps it; its texels are then clear of the own plane sooner. Lengths in voxels.
class Path {
 public:
  /// @param apex in voxels @param descends to the line from the surface point
  Path(const glm::vec3& apex, const glm::vec3& direction, const OwnPlane& own, bool descends)
      : apex_(apex), direction_(direction), lift_(own.lift) {
    height_ = glm::dot(own.normal, own.lift);
    rise_ = glm::dot(own.normal, direction);
    if (descends && height_ > 0.0f) descent_ = std::max(rise_, 0.0f) / height_;
  }
  glm::vec3 operator()(float s) const { return apex_ + s * direction_ - given_up(s) * lift_; }
  float height(float s) const { return height_ + s * rise_ - given_up(s) * height_; }  ///< over the own plane
  /// Of the line that the march ends on.
  glm::vec3 origin() const { return descent_ > 0.0f ? apex_ - lift_ : apex_; }

  /// A stretch that is straight.
  struct Straight {
    glm::vec3 direction;  ///< per unit of s
    float end;            ///< it lasts until there
  };
  Straight straight(float s) const {
    if (s * descent_ >= 1.0f || descent_ == 0.0f) return {direction_, infinity};
    return {direction_ - descent_ * lift_, 1.0f / descent_};
  }

 private:
  float given_up(float s) const { return std::min(s * descent_, 1.0f); }  ///< share of the lift

  glm::vec3 apex_, direction_, lift_;
  float height_ = 0.0f, rise_ = 0.0f, descent_ = 0.0f;
};

/// How fine a cone samples, along its way; lengths in voxels.
class Resolution {
 public:
  /// @param widening of the texels per unit of s
  Resolution(float widening, const Path& path, const glm::vec3& own_normal, float coarsest)
      : path_(path), widening_(widening), coarsest_(coarsest) {
    // A filter reaches 1.5 texels along each axis, thus 1.5 |n|_1 texels towards the plane.
    const float reach = 1.5f * (std::abs(own_normal.x) + std::abs(own_normal.y) + std::abs(own_normal.z));
    if (reach > 0.0f) clear_per_height_ = 1.0f / reach;
  }
  /// Side of the texels at distance s: the cone's share, within what the pyramid holds and the own plane allows.
  float texel(float s) const {
    const float side = std::clamp(widening_ * s, 1.0f, coarsest_);
    if (clear_per_height_ == 0.0f) return side;
    // Between two levels the coarser one must stay clear of the plane as well: the greatest is a whole level.
    return std::min(side, power_of_two_below(std::max(path_.height(s) * clear_per_height_, 1.0f)));
  }

 private:
  const Path& path_;
  float widening_, coarsest_;
  float clear_per_height_ = 0.0f;  ///< texels over the own plane's height; 0: there is no such plane
};

/// A stretch of a march on which nothing is stored.
struct Emptiness {
  float end = 0.0f;   ///< of the stretch
  float side = 0.0f;  ///< it is empty for texels up to this wide
};

/// How far an absent brick of level k reaches from p on. Of its texels those half a texel in from its faces are
/// interpolated from it alone, and finer levels have no bricks inside of it either.
template <class Texel>
float empty_length(const BrickVolume<Texel>& volume, const glm::vec3& p, const glm::vec3& direction, float cell) {
  constexpr int side = BrickVolume<Texel>::side;
  const glm::vec3 in_bricks = p / (cell * side);
  const glm::ivec3 brick(floor_to_int(in_bricks.x), floor_to_int(in_bricks.y), floor_to_int(in_bricks.z));
  if (!volume.contains(brick * side) || volume.slot(brick) != BrickVolume<Texel>::absent) return 0.0f;
  const glm::vec3 margin(0.5f * cell), inner = p - cell * glm::vec3(brick * side) - margin;
  const Interval inside = clip(inner, direction, glm::vec3(cell * side) - 2.0f * margin);
  return inside.begin == 0.0f ? inside.end : 0.0f;
}

/// What lies ahead of a sample that saw nothing, from the widest absent brick around it.
Emptiness empty_ahead(const Medium& medium, const Path& path, float s, float side) {
  constexpr int levels_up = 3;  // beyond, bricks are seldom absent
  const Path::Straight straight = path.straight(s);
  const glm::vec3 p = path(s);
  const int finest = static_cast<int>(std::ceil(std::log2(side)));
  for (int k = std::min(finest + levels_up, medium.top()); k >= finest; --k) {
    const float cell = Medium::cell(k);
    const float length = k == 0 ? empty_length(medium.texels.base, p, straight.direction, cell)
                                : empty_length(medium.texels.levels[size_t(k - 1)], p, straight.direction, cell);
    if (length > 0.0f) return {std::min(s + length, straight.end), cell};
  }
  return {};
}

}  // namespace

ConeSample march(const Medium& medium, const glm::vec3& origin, const glm::vec3& direction, float tan_half_angle,
                 const OwnPlane& own, const MarchOptions& options, float max_distance) {
  const Grid& grid = medium.texels.grid;
  const glm::vec3 start = grid.to_voxels(origin);
  const float widening = 2.0f * tan_half_angle * options.texel;
  const Path path(start, direction, own, options.texel < 1.0f);
  const Resolution resolution(widening, path, own.normal, coarsest_texel(medium));
  const DirectionalRead read(direction);

  // Filters of texels at the box's border reach half a texel out of it, and border texels stick out of it by up to one.
  Interval inside = clip(path.origin(), direction, glm::vec3(grid.size));
  if (inside.begin < inside.end) inside.end += 1.5f * resolution.texel(inside.end);
  inside.end = std::min(inside.end, max_distance / grid.voxel);

  Float4 gathered{};  // premultiplied radiance
  float transmittance = 1.0f, occlusion = 0.0f;
  // The texels of wide cones outgrow a brick's level within a step or two.
  const bool skips = widening < 0.5f;
  Emptiness empty;
  for (float s = inside.begin; s < inside.end;) {
    // The middle of the step stands for it: halving the steps then changes little.
    const float length = std::min(options.step * resolution.texel(s), inside.end - s);
    const float middle = s + 0.5f * length;
    if (s + length <= s) break;  // so close to the end that float32 cannot step
    s += length;
    const float side = resolution.texel(middle);
    if (middle < empty.end && side <= empty.side) continue;
    const Float4 sample = quadrilinear(medium, path(middle), std::log2(side), read);
    const float sigma = sample[3];
    if (sigma == 0.0f) {
      if (skips) empty = empty_ahead(medium, path, middle, side);
      continue;
    }

    const float through = std::exp(-sigma * length);
    const float absorbed = transmittance * (1.0f - through);
    gathered += (absorbed / sigma) * sample;
    occlusion += absorbed / (1.0f + options.falloff * middle);
    transmittance *= through;
    if (transmittance <= opaque_transmittance) {
      gathered += (transmittance / sigma) * sample;
      occlusion += transmittance / (1.0f + options.falloff * middle);
      transmittance = 0.0f;
      break;
    }
  }
  ConeSample result;
  result.radiance = glm::vec3(to_vec4(gathered));
  result.opacity = 1.0f - transmittance;
  result.occlusion = std::min(occlusion, 1.0f);
  if (max_distance == infinity) result.radiance += transmittance * options.background;
  return result;
}

float march_opacity(const Medium& medium, const glm::vec3& from, const glm::vec3& to, float tan_half_angle,
                    float step) {
  const float distance = glm::distance(from, to);
  if (distance == 0.0f) return 0.0f;
  MarchOptions options;
  options.step = step;
  return march(medium, from, (to - from) / distance, tan_half_angle, OwnPlane{}, options, distance).opacity;
}

}  // namespace voxref
