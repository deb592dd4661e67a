#include "cone/raw_march.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "cone/interpolate_wide.h"
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

ConeSteps::ConeSteps(std::vector<ConeStep> steps, float voxel) : steps_(std::move(steps)) {
  const auto padded = [](size_t count) { return (count + lanes - 1) / lanes * lanes; };
  for (size_t i = 0; !steps_.empty() && i < padded(size()); ++i) {
    const ConeStep& step = steps_[std::min(i, size() - 1)];
    distances_.push_back(step.distance);
    coarsest_.push_back(step.coarsest());
    coarser_shares_.push_back(step.coarser_share());
  }
  if (!narrow()) return;
  for (size_t begin = 0; begin < size(); begin += lanes) add_group(begin, std::min(begin + lanes, size()), voxel);
  group_distances_.resize(padded(group_distances_.size()), group_distances_.back());
  group_levels_.resize(padded(group_levels_.size()), group_levels_.back());
}

// In a level at least as coarse as the samples' own, whose texels are as long as the group, each sample lies half a
// texel from the group's middle at the most along any axis. The eight texels that it reads are then among the 4^3 that
// the eight of the next level around the middle are made of.
void ConeSteps::add_group(size_t begin, size_t end, float voxel) {
  const float first = steps_[begin].distance, last = steps_[end - 1].distance;
  constexpr float rounding = 1.001f;  // of positions
  const int as_long = static_cast<int>(std::ceil(std::log2(std::max(rounding * (last - first) / voxel, 1.0f))));
  group_distances_.push_back(0.5f * (first + last));
  group_levels_.push_back(std::max(as_long, steps_[end - 1].coarsest()) + 1);
}

namespace {

/// The samples of a cone at which there may be something: calls visit(step, samples, lane) for them until it returns
/// false. Where they are is found for many of them before the first is visited: a processor that knows what comes next
/// overlaps one look-up with another, and does not wait for each to tell whether there is a next one.
/// @param last texel of the base along each axis
template <class Visit>
inline void for_each_sample(const Int4& last, const Occupancy& occupied, const ConeAxis& axis, const ConeSteps& steps,
                            float end, const Visit& visit) {
  constexpr size_t lanes = ConeSteps::lanes, most_groups = lanes;
  const Float4 &o = axis.origin, &w = axis.way;
  for (size_t begin = 0; begin < steps.size() && steps[begin].distance <= end; begin += lanes * most_groups) {
    const size_t count = std::min(lanes * most_groups, steps.size() - begin);
    uint32_t found[most_groups] = {}, groups = ~0u;
    if (steps.narrow()) {
      Float8 s;
      Int8 level;
      steps.load_groups(begin / lanes, s, level);
      level = level < occupied.top() ? level : occupied.top();  // one texel, of all there is
      groups = occupied(level, o[0] + s * w[0], o[1] + s * w[1], o[2] + s * w[2]);
    }
    for (size_t k = 0; lanes * k < count; ++k) {
      if (!(groups >> k & 1u) || steps[begin + lanes * k].distance > end) continue;
      const auto [s, level, ignored] = steps.load(begin + lanes * k);
      found[k] = occupied(level, o[0] + s * w[0], o[1] + s * w[1], o[2] + s * w[2]);
      if (count < lanes * (k + 1)) found[k] &= (1u << (count - lanes * k)) - 1;
    }
    for (size_t k = 0; lanes * k < count; ++k) {
      if (found[k] == 0) continue;
      const auto [s, level, share] = steps.load(begin + lanes * k);
      const RawSamples samples(last, level, share, o[0] + s * w[0], o[1] + s * w[1], o[2] + s * w[2]);
      for (uint32_t bits = found[k]; bits != 0; bits &= bits - 1) {
        const auto lane = size_t(std::countr_zero(bits));
        const ConeStep& step = steps[begin + lanes * k + lane];
        if (step.distance > end || !visit(step, samples, lane)) return;
      }
    }
  }
}

template <class Texel>
Int4 last_texel(const BasicPyramid<Texel>& pyramid) {
  return to_int4(pyramid.base.size()) - 1;
}

template <class Kernel, class Texel>
inline RawCone march(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const ConeAxis& axis,
                     const ConeSteps& steps) {
  const SquaredRead read(axis.direction);
  Float4 gathered{};
  float opacity = 0.0f, occlusion = 0.0f;
  constexpr float endless = std::numeric_limits<float>::infinity();
  for_each_sample(last_texel(pyramid), occupied, axis, steps, endless,
                  [&](const ConeStep& step, const RawSamples& samples, size_t lane) {
                    const Float4 sample = sample_raw<Kernel>(pyramid, samples, lane, step, read);
                    gathered += (1.0f - opacity) * sample;
                    opacity = gathered[3];
                    if (occlusion < 1.0f) occlusion += (1.0f - occlusion) * sample[3] * step.occlusion;
                    return opacity < 1.0f;
                  });
  return {{gathered[0], gathered[1], gathered[2]}, opacity, occlusion};
}

template <class Kernel, class Texel>
inline float march_shadow(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const ConeAxis& axis,
                          const ConeSteps& steps, float end, float gain) {
  constexpr float least_alpha = 1e-30f;  // the published shaders' EPSILON: any stored alpha is above it
  const SquaredRead read(axis.direction);
  const bool hard = gain == std::numeric_limits<float>::infinity();
  float blocked = 0.0f;
  for_each_sample(last_texel(pyramid), occupied, axis, steps, end,
                  [&](const ConeStep& step, const RawSamples& samples, size_t lane) {
                    const float alpha = step.coarsest() == 0
                                            ? base_alpha(pyramid, samples, lane)
                                            : sample_raw<Kernel>(pyramid, samples, lane, step, read)[3];
                    if (hard && alpha > least_alpha)
                      blocked = 1.0f;
                    else if (alpha != 0.0f)
                      blocked += (1.0f - blocked) * alpha * gain;
                    return blocked < 1.0f;
                  });
  return std::max(1.0f - blocked, 0.0f);
}

template <class Texel>
VOXREF_WIDE_ALL RawCone march_wide(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const ConeAxis& axis,
                                   const ConeSteps& steps) {
  return march<WideKernel>(pyramid, occupied, axis, steps);
}
template <class Texel>
VOXREF_WIDE_ALL float march_shadow_wide(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied,
                                        const ConeAxis& axis, const ConeSteps& steps, float end, float gain) {
  return march_shadow<WideKernel>(pyramid, occupied, axis, steps, end, gain);
}

}  // namespace

template <class Texel>
RawCone march_raw(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const ConeAxis& axis,
                  const ConeSteps& steps) {
  return wide_machine ? march_wide(pyramid, occupied, axis, steps) : march<PlainKernel>(pyramid, occupied, axis, steps);
}

template <class Texel>
float march_raw_shadow(const BasicPyramid<Texel>& pyramid, const Occupancy& occupied, const ConeAxis& axis,
                       const ConeSteps& steps, float end, float gain) {
  return wide_machine ? march_shadow_wide(pyramid, occupied, axis, steps, end, gain)
                      : march_shadow<PlainKernel>(pyramid, occupied, axis, steps, end, gain);
}

template RawCone march_raw(const BasicPyramid<glm::vec4>&, const Occupancy&, const ConeAxis&, const ConeSteps&);
template float march_raw_shadow(const BasicPyramid<glm::vec4>&, const Occupancy&, const ConeAxis&, const ConeSteps&,
                                float, float);
template RawCone march_raw(const BasicPyramid<Rgba16f>&, const Occupancy&, const ConeAxis&, const ConeSteps&);
template float march_raw_shadow(const BasicPyramid<Rgba16f>&, const Occupancy&, const ConeAxis&, const ConeSteps&,
                                float, float);
template RawCone march_raw(const BasicPyramid<Rgba8>&, const Occupancy&, const ConeAxis&, const ConeSteps&);
template float march_raw_shadow(const BasicPyramid<Rgba8>&, const Occupancy&, const ConeAxis&, const ConeSteps&, float,
                                float);

bool meets(const Bounds& box, const glm::vec3& origin, const glm::vec3& direction) {
  const glm::vec3 a = (box.min - origin) / direction, b = (box.max - origin) / direction;
  const glm::vec3 far = glm::max(a, b), near = glm::min(a, b);
  const float leave = glm::min(far.x, glm::min(far.y, far.z));
  const float enter = glm::max(glm::max(near.x, 0.0f), glm::max(near.y, near.z));
  return leave > enter;
}

}  // namespace voxref
