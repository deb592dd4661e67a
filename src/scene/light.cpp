#include "scene/light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace voxref {

Illumination illuminate(const Light& light, const glm::vec3& point) {
  if (light.type == LightType::directional)
    return {-light.direction, std::numeric_limits<float>::infinity(), light.intensity};

  const glm::vec3 offset = light.position - point;
  const float distance_squared = glm::dot(offset, offset);
  if (!(distance_squared > 0.0f)) return {};
  Illumination result;
  result.distance = std::sqrt(distance_squared);
  const float inverse = 1.0f / result.distance;  // one division instead of six
  result.to_light = inverse * offset;
  result.irradiance = (inverse * inverse) * light.intensity;
  if (light.type == LightType::spot) {
    constexpr float least_range = 0.001f;  // KHR_lights_punctual: keeps equal cone angles from dividing by zero
    const float cosine = -glm::dot(light.direction, result.to_light);
    const float ramp =
        std::clamp((cosine - light.cos_outer) / std::max(light.cos_inner - light.cos_outer, least_range), 0.0f, 1.0f);
    result.irradiance *= ramp * ramp;
  }
  return result;
}

}  // namespace voxref
