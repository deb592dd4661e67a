#include "scene/light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace voxref {

namespace {

float falloff(float distance, const LightOptions& options) {
  if (options.falloff == LightFalloff::inverse_square) {
    const float inverse = 1.0f / distance;
    return inverse * inverse;
  }
  const glm::vec3& k = options.attenuation;
  return 1.0f / (1.0f + k.x + k.y * distance + k.z * (distance * distance));
}

float spot_ramp(float ramp, const LightOptions& options) {
  return options.falloff == LightFalloff::inverse_square ? ramp * ramp : ramp * ramp * (3.0f - 2.0f * ramp);
}

}  // namespace

Illumination illuminate(const Light& light, const glm::vec3& point, const LightOptions& options) {
  if (light.type == LightType::directional)
    return {-light.direction, std::numeric_limits<float>::infinity(), 1.0f, light.intensity};

  const glm::vec3 offset = light.position - point;
  const float distance_squared = glm::dot(offset, offset);
  if (!(distance_squared > 0.0f)) return {};
  Illumination result;
  result.distance = std::sqrt(distance_squared);
  result.to_light = (1.0f / result.distance) * offset;  // one division instead of three
  result.attenuation = falloff(result.distance, options);
  if (light.type == LightType::spot) {
    constexpr float least_range = 0.001f;  // KHR_lights_punctual: keeps equal cone angles from dividing by zero
    const float cosine = -glm::dot(light.direction, result.to_light);
    const float ramp =
        std::clamp((cosine - light.cos_outer) / std::max(light.cos_inner - light.cos_outer, least_range), 0.0f, 1.0f);
    result.attenuation *= spot_ramp(ramp, options);
  }
  result.irradiance = result.attenuation * light.intensity;
  return result;
}

}  // namespace voxref
