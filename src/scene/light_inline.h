#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "scene/light.h"

namespace voxref {

/// Irradiance of a facing surface over intensity. @param distance world units, above 0
inline float falloff(float distance, const LightOptions& options) {
  if (options.falloff == LightFalloff::inverse_square) {
    const float inverse = 1.0f / distance;
    return inverse * inverse;
  }
  const glm::vec3& k = options.attenuation;
  return 1.0f / (1.0f + k.x + k.y * distance + k.z * (distance * distance));
}

/// illuminate() for a point light, or for a spot light: inline and without branches that depend on the point, so that
/// loops over many points become instructions that work on several at once.
inline Illumination illuminate_near(const Light& light, bool spot, const glm::vec3& point,
                                    const LightOptions& options = {}) {
  const glm::vec3 offset = light.position - point;
  const float distance_squared = glm::dot(offset, offset);
  const float there = distance_squared > 0.0f ? 1.0f : 0.0f;
  const float distance = std::sqrt(there > 0.0f ? distance_squared : 1.0f);
  const float inverse = there / distance;  // one division instead of three
  const glm::vec3 to_light(inverse * offset.x, inverse * offset.y, inverse * offset.z);
  float attenuation = there * falloff(distance, options);
  if (spot) {
    // KHR_lights_punctual keeps equal cone angles from dividing by zero; the published ramp knows no such floor.
    const float least_range =
        options.falloff == LightFalloff::inverse_square ? 0.001f : std::numeric_limits<float>::min();
    const float range = std::max(light.cos_inner - light.cos_outer, least_range);
    const float ramp = (-glm::dot(light.direction, to_light) - light.cos_outer) / range;
    const float t = std::min(std::max(ramp, 0.0f), 1.0f);
    attenuation *= options.falloff == LightFalloff::inverse_square ? t * t : t * t * (3.0f - 2.0f * t);
  }
  return {{to_light.x, to_light.y, to_light.z},
          there * distance,
          attenuation,
          {attenuation * light.intensity.x, attenuation * light.intensity.y, attenuation * light.intensity.z}};
}

}  // namespace voxref
