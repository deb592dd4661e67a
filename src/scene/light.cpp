#include "scene/light.h"

#include <limits>

#include "scene/light_inline.h"

namespace voxref {

Illumination illuminate(const Light& light, const glm::vec3& point, const LightOptions& options) {
  if (light.type == LightType::directional)
    return {-light.direction, std::numeric_limits<float>::infinity(), 1.0f, light.intensity};
  return illuminate_near(light, light.type == LightType::spot, point, options);
}

}  // namespace voxref
