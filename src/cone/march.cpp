#include "cone/march.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "cone/interpolate_wide.h"
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
float coarsest_texel(const glm::ivec3& size, int top) {
  const float quarter = static_cast<float>(std::min({size.x, size.y, size.z})) / 4.0f;
  const float sixteenth = static_cast<float>(std::max({size.x, size.y, size.z})) / 16.0f;
  return std::min(Medium::cell(top), std::max({quarter, sixteenth, 1.0f}));
}

/// The way of a march: from the apex along the plane of the own surface until the line from the surface point has
/// risen to the same height, then along that line. Texels as wide as the cone blur by more than the lift, so that such
/// a cone keeps it; its texels are then clear of the own plane sooner. Lengths in voxels.
class Path {
 public:
  /// @param apex in voxels @param descends to the line from the surface point
  Path(const glm::vec3& apex, const glm::vec3& direction, const OwnPlane& own, bool descends)
      : apex_(to_float4(apex)), direction_(to_float4(direction)), lift_(to_float4(own.lift)) {
    height_ = glm::dot(own.normal, own.lift);
    rise_ = glm::dot(own.normal, direction);
    inverse_rise_ = 1.0f / rise_;
    if (descends && height_ > 0.0f) descent_ = std::max(rise_, 0.0f) / height_;
    const Float4 descending = direction_ - descent_ * lift_;
    first_ = Straight{descending, 1.0f / descending, descent_ > 0.0f ? 1.0f / descent_ : 0.0f};
    last_ = Straight{direction_, 1.0f / direction_, infinity};
  }
  Float4 operator()(float s) const { return apex_ + s * direction_ - given_up(s) * lift_; }
  float height(float s) const { return height_ + s * rise_ - given_up(s) * height_; }  ///< over the own plane
  /// Of the line that the march ends on.
  glm::vec3 origin() const { return glm::vec3(to_vec4(descent_ > 0.0f ? apex_ - lift_ : apex_)); }

  /// A stretch that is straight.
  struct Straight {
    Float4 direction;  ///< per unit of s
    Float4 inverse;    ///< 1 / direction
    float end;         ///< it lasts until there
  };
  const Straight& straight(float s) const { return s < first_.end ? first_ : last_; }
  /// Distance from which on the march is this high over the own plane; while it descends it stays as high as it began.
  float distance_at(float height) const {
    if (height <= height_) return 0.0f;
    return (height - (descent_ > 0.0f ? 0.0f : height_)) * inverse_rise_;
  }

 private:
  float given_up(float s) const { return std::min(s * descent_, 1.0f); }  ///< share of the lift

  Float4 apex_, direction_, lift_;
  float height_ = 0.0f, rise_ = 0.0f, inverse_rise_ = infinity, descent_ = 0.0f;
  Straight first_, last_;
};

/// How fine a cone samples, along its way; lengths in voxels.
class Resolution {
 public:
  /// @param widening of the texels per unit of s
  Resolution(float widening, const Path& path, const glm::vec3& own_normal, float coarsest)
      : path_(path), widening_(widening), inverse_(1.0f / widening), coarsest_(coarsest) {
    // A filter reaches 1.5 texels along each axis, thus 1.5 |n|_1 texels towards the plane.
    const float reach = 1.5f * (std::abs(own_normal.x) + std::abs(own_normal.y) + std::abs(own_normal.z));
    if (reach > 0.0f) clear_per_height_ = 1.0f / reach;
    height_per_clear_ = reach;
  }
  /// Side of the texels at distance s: the cone's share, within what the pyramid holds and the own plane allows. It
  /// does not shrink along the way, since cones do not point below the plane.
  float texel(float s) const {
    const float side = std::clamp(widening_ * s, 1.0f, coarsest_);
    if (clear_per_height_ == 0.0f) return side;
    // Between two levels the coarser one must stay clear of the plane as well: the greatest is a whole level.
    return std::min(side, power_of_two_below(std::max(path_.height(s) * clear_per_height_, 1.0f)));
  }
  /// Up to where texels are no wider than `side`, a power of two.
  float until(float side) const {
    if (side >= coarsest_) return infinity;
    const float cone = side * inverse_;
    if (clear_per_height_ == 0.0f) return cone;
    return std::max(cone, path_.distance_at(2.0f * side * height_per_clear_));
  }

 private:
  const Path& path_;
  float widening_, inverse_, coarsest_;
  float clear_per_height_ = 0.0f;  ///< texels over the own plane's height; 0: there is no such plane
  float height_per_clear_ = 0.0f;
};

/// Level of texels of this width or, between two levels, the coarser one. @param side at least 1
int level_above(float side) {
  const uint32_t bits = std::bit_cast<uint32_t>(side);
  return static_cast<int>((bits >> 23) - 127) + ((bits & 0x7fffffu) != 0);
}

/// Where what is empty at distance s ends: `level` is, around p there.
float end_of_gap(const Occupancy& occupied, const Path& path, const Resolution& resolution, float s, const Float4& p,
                 int level) {
  const Path::Straight& straight = path.straight(s);
  const Occupancy::Gap gap = occupied.gap(level, p, straight.direction, straight.inverse);
  return std::min({s + gap.length, straight.end, resolution.until(Medium::cell(gap.level))});
}

template <class Kernel, class Texel>
inline ConeSample march_by(const BasicMedium<Texel>& medium, const glm::vec3& origin, const glm::vec3& direction,
                           float tan_half_angle, const OwnPlane& own, const MarchOptions& options, float max_distance) {
  const Grid& grid = medium.texels.grid;
  const glm::vec3 start = grid.to_voxels(origin);
  const float widening = 2.0f * tan_half_angle * options.texel;
  const Path path(start, direction, own, options.texel < 1.0f);
  const Resolution resolution(widening, path, own.normal, coarsest_texel(grid.size, medium.top()));
  const OpticalRead read(direction);

  // Filters of texels at the box's border reach half a texel out of it, and border texels stick out of it by up to one.
  Interval inside = clip(path.origin(), direction, glm::vec3(grid.size));
  if (inside.begin < inside.end) inside.end += 1.5f * resolution.texel(inside.end);
  inside.end = std::min(inside.end, max_distance / grid.voxel);

  Float4 gathered{};  // premultiplied radiance
  float transmittance = 1.0f, occlusion = 0.0f;
  for (float s = inside.begin; s < inside.end;) {
    // The middle of the step stands for it: halving the steps then changes little.
    const float length = std::min(options.step * resolution.texel(s), inside.end - s);
    const float middle = s + 0.5f * length;
    if (s + length <= s) break;  // so close to the end that float32 cannot step
    s += length;
    const float side = resolution.texel(middle);
    const Float4 p = path(middle);
    const int level = level_above(side);
    if (!medium.occupied(level, p)) {
      s = std::max(s, end_of_gap(medium.occupied, path, resolution, middle, p, level));
      continue;
    }
    const Float4 sample = quadrilinear<Kernel>(medium, p, std::log2(side), read);
    const float sigma = sample[3];
    if (sigma == 0.0f) continue;

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

template <class Texel>
VOXREF_WIDE_ALL ConeSample march_wide(const BasicMedium<Texel>& medium, const glm::vec3& origin,
                                      const glm::vec3& direction, float tan_half_angle, const OwnPlane& own,
                                      const MarchOptions& options, float max_distance) {
  return march_by<WideKernel>(medium, origin, direction, tan_half_angle, own, options, max_distance);
}

}  // namespace

template <class Texel>
ConeSample march(const BasicMedium<Texel>& medium, const glm::vec3& origin, const glm::vec3& direction,
                 float tan_half_angle, const OwnPlane& own, const MarchOptions& options, float max_distance) {
  return wide_machine ? march_wide(medium, origin, direction, tan_half_angle, own, options, max_distance)
                      : march_by<PlainKernel>(medium, origin, direction, tan_half_angle, own, options, max_distance);
}

template <class Texel>
float march_opacity(const BasicMedium<Texel>& medium, const glm::vec3& from, const glm::vec3& to, float tan_half_angle,
                    float step) {
  const float distance = glm::distance(from, to);
  if (distance == 0.0f) return 0.0f;
  MarchOptions options;
  options.step = step;
  return march(medium, from, (to - from) / distance, tan_half_angle, OwnPlane{}, options, distance).opacity;
}

template ConeSample march(const Medium&, const glm::vec3&, const glm::vec3&, float, const OwnPlane&,
                          const MarchOptions&, float);
template ConeSample march(const Medium16&, const glm::vec3&, const glm::vec3&, float, const OwnPlane&,
                          const MarchOptions&, float);
template ConeSample march(const Medium8&, const glm::vec3&, const glm::vec3&, float, const OwnPlane&,
                          const MarchOptions&, float);
template float march_opacity(const Medium&, const glm::vec3&, const glm::vec3&, float, float);
template float march_opacity(const Medium16&, const glm::vec3&, const glm::vec3&, float, float);
template float march_opacity(const Medium8&, const glm::vec3&, const glm::vec3&, float, float);

}  // namespace voxref
