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

template <class Texel>
RawCone march_raw(const BasicPyramid<Texel>& pyramid, const glm::vec3& start, const glm::vec3& direction,
                  const std::vector<ConeStep>& steps) {
  const glm::vec3 origin = pyramid.grid.to_voxels(start), way = direction / pyramid.grid.voxel;
  const SquaredRead read(direction);
  Float4 gathered{};
  float occlusion = 0.0f;
  for (const ConeStep& step : steps) {
    const Float4 sample = sample_raw(pyramid, origin + step.distance * way, step, read);
    gathered += (1.0f - gathered[3]) * sample;
    if (occlusion < 1.0f) occlusion += (1.0f - occlusion) * sample[3] * step.occlusion;
    if (gathered[3] >= 1.0f) break;
  }
  return {{gathered[0], gathered[1], gathered[2]}, gathered[3], occlusion};
}

/// Opacity alone of the base volume.
template <class Texel>
float base_alpha(const BrickVolume<Texel>& base, const glm::vec3& p) {
  const Corners<Texel> corners = corners_around(base, p);
  if (corners.empty) return 0.0f;
  std::array<float, 8> alphas;
  for (size_t i = 0; i < 8; ++i) alphas[i] = decode_alpha(*corners.texels[i]);
  return mix_corners(alphas, corners.f);
}

template <class Texel>
float march_raw_shadow(const BasicPyramid<Texel>& pyramid, const EmptySpace& empty, const glm::vec3& start,
                       const glm::vec3& direction, const std::vector<ConeStep>& steps, float end, float gain) {
  constexpr float least_alpha = 1e-30f;  // the published shaders' EPSILON: any stored alpha is above it
  const glm::vec3 origin = pyramid.grid.to_voxels(start), way = direction / pyramid.grid.voxel;
  const SquaredRead read(direction);
  const bool hard = gain == std::numeric_limits<float>::infinity();
  float blocked = 0.0f, empty_until = 0.0f;
  for (const ConeStep& step : steps) {
    if (step.distance > end) break;
    const bool base_alone = step.level == 0 && step.fraction == 0.0f;
    if (base_alone && step.distance < empty_until) continue;
    const glm::vec3 p = origin + step.distance * way;
    float alpha = 0.0f;
    if (!base_alone)
      alpha = sample_raw(pyramid, p, step, read)[3];
    else if (const float reach = empty.reach(p, way); reach > 0.0f)
      empty_until = step.distance + reach;
    else
      alpha = base_alpha(pyramid.base, p);
    if (alpha == 0.0f) continue;
    if (hard && alpha > least_alpha) return 0.0f;
    blocked += (1.0f - blocked) * alpha * gain;
    if (blocked >= 1.0f) return 0.0f;
  }
  return 1.0f - blocked;
}

template RawCone march_raw(const BasicPyramid<glm::vec4>&, const glm::vec3&, const glm::vec3&,
                           const std::vector<ConeStep>&);
template RawCone march_raw(const BasicPyramid<Rgba16f>&, const glm::vec3&, const glm::vec3&,
                           const std::vector<ConeStep>&);
template RawCone march_raw(const BasicPyramid<Rgba8>&, const glm::vec3&, const glm::vec3&,
                           const std::vector<ConeStep>&);
template float march_raw_shadow(const BasicPyramid<glm::vec4>&, const EmptySpace&, const glm::vec3&, const glm::vec3&,
                                const std::vector<ConeStep>&, float, float);
template float march_raw_shadow(const BasicPyramid<Rgba16f>&, const EmptySpace&, const glm::vec3&, const glm::vec3&,
                                const std::vector<ConeStep>&, float, float);
template float march_raw_shadow(const BasicPyramid<Rgba8>&, const EmptySpace&, const glm::vec3&, const glm::vec3&,
                                const std::vector<ConeStep>&, float, float);

bool meets(const Bounds& box, const glm::vec3& origin, const glm::vec3& direction) {
  const glm::vec3 a = (box.min - origin) / direction, b = (box.max - origin) / direction;
  const glm::vec3 far = glm::max(a, b), near = glm::min(a, b);
  const float leave = glm::min(far.x, glm::min(far.y, far.z));
  const float enter = glm::max(glm::max(near.x, 0.0f), glm::max(near.y, near.z));
  return leave > enter;
}

}  // namespace voxref
