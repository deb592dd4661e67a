#include "cone/raw_march.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "cone/raw_lookup.h"

namespace voxref {

std::vector<ConeStep> cone_steps(float tan_half_angle, const ConeStepping& stepping) {
  assert(tan_half_angle > 0.0f);
  std::vector<ConeStep> steps;
  for (float s = stepping.unit; s <= stepping.end;) {
    const float diameter = 2.0f * tan_half_angle * s;
    const float level = std::clamp(std::log2(diameter / stepping.unit), 0.0f, static_cast<float>(stepping.top));
    const int finer = static_cast<int>(level);
    steps.push_back({s, finer, level - static_cast<float>(finer), 1.0f / (1.0f + stepping.falloff * 0.5f * diameter)});
    const float next = s + diameter * stepping.step;
    if (next <= s) break;  // so narrow that float32 cannot step
    s = next;
  }
  return steps;
}

namespace {

/// Opacity alone of the base volume.
template <class Texel>
float base_alpha(const BrickVolume<Texel>& base, const Float4& p) {
  const Corners<Texel> corners = corners_clamped(base, p);
  if (corners.empty) return 0.0f;
  std::array<float, 8> alphas;
  for (size_t i = 0; i < 8; ++i) alphas[i] = decode_alpha(*corners.texels[i]);
  return mix_corners(alphas, corners.f);
}

/// The samples of a cone at which there may be something: calls visit(step, position in voxels) for them until it
/// returns false.
template <class Visit>
void for_each_sample(const Occupancy& occupied, const Float4& origin, const Float4& way,
                     const std::vector<ConeStep>& steps, float end, Visit&& visit) {
  // Samples of wide cones lie too far apart for two of them to fall into one gap.
  constexpr size_t many = 32;
  const bool leaps = steps.size() > many;
  const Float4 inverse = 1.0f / way;
  float empty_until = 0.0f;
  int empty_level = 0;
  for (const ConeStep& step : steps) {
    if (step.distance > end) break;
    const int level = step.coarsest();
    if (step.distance < empty_until && level <= empty_level) continue;
    const Float4 p = origin + step.distance * way;
    if (occupied(level, p)) {
      if (!visit(step, p)) break;
    } else if (leaps) {
      const Occupancy::Gap gap = occupied.gap(level, p, way, inverse);
      empty_until = step.distance + gap.length;
      empty_level = gap.level;
    }
  }
}

}  // namespace

template <class Texel>
RawCone march_raw(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const glm::vec3& start,
                  const glm::vec3& direction, const std::vector<ConeStep>& steps) {
  const Float4 origin = to_float4(pyramid.grid.to_voxels(start)), way = to_float4(direction / pyramid.grid.voxel);
  const SquaredRead read(direction);
  Float4 gathered{};
  float occlusion = 0.0f;
  constexpr float endless = std::numeric_limits<float>::infinity();
  for_each_sample(occupied, origin, way, steps, endless, [&](const ConeStep& step, const Float4& p) {
    const Float4 sample = sample_raw(pyramid, p, step, read);
    gathered += (1.0f - gathered[3]) * sample;
    if (occlusion < 1.0f) occlusion += (1.0f - occlusion) * sample[3] * step.occlusion;
    return gathered[3] < 1.0f;
  });
  return {{gathered[0], gathered[1], gathered[2]}, gathered[3], occlusion};
}

template <class Texel>
float march_raw_shadow(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const glm::vec3& start,
                       const glm::vec3& direction, const std::vector<ConeStep>& steps, float end, float gain) {
  constexpr float least_alpha = 1e-30f;  // the published shaders' EPSILON: any stored alpha is above it
  const Float4 origin = to_float4(pyramid.grid.to_voxels(start)), way = to_float4(direction / pyramid.grid.voxel);
  const SquaredRead read(direction);
  const bool hard = gain == std::numeric_limits<float>::infinity();
  float blocked = 0.0f;
  for_each_sample(occupied, origin, way, steps, end, [&](const ConeStep& step, const Float4& p) {
    const float alpha = step.coarsest() == 0 ? base_alpha(pyramid.base, p) : sample_raw(pyramid, p, step, read)[3];
    if (hard && alpha > least_alpha)
      blocked = 1.0f;
    else if (alpha != 0.0f)
      blocked += (1.0f - blocked) * alpha * gain;
    return blocked < 1.0f;
  });
  return std::max(1.0f - blocked, 0.0f);
}

template RawCone march_raw(const BasicPyramid<glm::vec4>&, const Occupancy&, const glm::vec3&, const glm::vec3&,
                           const std::vector<ConeStep>&);
template float march_raw_shadow(const BasicPyramid<glm::vec4>&, const Occupancy&, const glm::vec3&, const glm::vec3&,
                                const std::vector<ConeStep>&, float, float);
template RawCone march_raw(const BasicPyramid<Rgba16f>&, const Occupancy&, const glm::vec3&, const glm::vec3&,
                           const std::vector<ConeStep>&);
template float march_raw_shadow(const BasicPyramid<Rgba16f>&, const Occupancy&, const glm::vec3&, const glm::vec3&,
                                const std::vector<ConeStep>&, float, float);
template RawCone march_raw(const BasicPyramid<Rgba8>&, const Occupancy&, const glm::vec3&, const glm::vec3&,
                           const std::vector<ConeStep>&);
template float march_raw_shadow(const BasicPyramid<Rgba8>&, const Occupancy&, const glm::vec3&, const glm::vec3&,
                                const std::vector<ConeStep>&, float, float);

bool meets(const Bounds& box, const glm::vec3& origin, const glm::vec3& direction) {
  const glm::vec3 a = (box.min - origin) / direction, b = (box.max - origin) / direction;
  const glm::vec3 far = glm::max(a, b), near = glm::min(a, b);
  const float leave = glm::min(far.x, glm::min(far.y, far.z));
  const float enter = glm::max(glm::max(near.x, 0.0f), glm::max(near.y, near.z));
  return leave > enter;
}

}  // namespace voxref
