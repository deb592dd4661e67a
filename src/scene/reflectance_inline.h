#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/reflectance.h"

/// What reflectance.h declares of the same names, inline and without branches, so that loops over many points become
/// instructions that work on several at once.
namespace voxref::inlined {

inline float ggx_distribution(const glm::vec3& normal, const glm::vec3& half, float alpha) {
  const float a2 = alpha * alpha;
  // (n.h)^2 (a2 - 1) + 1 with the sine from the cross product: 1 - (n.h)^2 would have no digits left in a narrow lobe,
  // which then holds up to 8 % too much.
  const float cosine = glm::dot(normal, half);
  const glm::vec3 across = glm::cross(normal, half);
  const float d = a2 * cosine * cosine + glm::dot(across, across);
  return a2 / (std::numbers::pi_v<float> * d * d);
}

inline float ggx_visibility(float n_l, float n_v, float alpha) {
  const float a2 = alpha * alpha;
  const float from_l = n_v * std::sqrt(a2 + (1.0f - a2) * n_l * n_l);
  const float from_v = n_l * std::sqrt(a2 + (1.0f - a2) * n_v * n_v);
  return 0.5f / (from_l + from_v);
}

/// (1 - v.h)^5, Schlick 1994.
inline float schlick_weight(float v_h) {
  const float m = std::min(std::max(1.0f - v_h, 0.0f), 1.0f);
  return m * m * m * m * m;
}

inline glm::vec3 evaluate(const Reflectance& r, const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in) {
  const float n_v = glm::dot(normal, out), n_l = glm::dot(normal, in);
  const glm::vec3 h = glm::normalize(out + in);
  const float s = schlick_weight(glm::dot(out, h));
  const float lobe = ggx_distribution(normal, h, r.alpha) * ggx_visibility(n_l, n_v, r.alpha);
  const glm::vec3 f = r.diffuse / std::numbers::pi_v<float> * (1.0f - (r.layer_f0 + r.layer_f1 * s)) +
                      lobe * (r.specular_f0 + r.specular_f1 * s);
  const bool above = (n_v > 0.0f) & (n_l > 0.0f);
  return {above ? f.x : 0.0f, above ? f.y : 0.0f, above ? f.z : 0.0f};
}

}  // namespace voxref::inlined
