#include "scene/light.h"

#include <algorithm>
#include <limits>

#include "scene/light_inline.h"

namespace voxref {

Illumination illuminate(const Light& light, const glm::vec3& point, const LightOptions& options) {
  if (light.type == LightType::directional)
    return {-light.direction, std::numeric_limits<float>::infinity(), 1.0f, light.intensity};
  return illuminate_near(light, light.type == LightType::spot, point, options);
}

std::vector<Light> by_type(std::vector<Light> lights) {
  const auto rank = [](const Light& light) {
    return light.type == LightType::directional ? 0 : light.type == LightType::point ? 1 : 2;
  };
  std::ranges::stable_sort(lights, {}, rank);
  return lights;
}

}  // namespace voxref
