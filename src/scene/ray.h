#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace voxref {

struct Ray {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f};  ///< any length; distances along the ray are in multiples of it
  float tmin = 0.0f;
  float tmax = std::numeric_limits<float>::infinity();
};

struct Hit {
  static constexpr uint32_t none = ~0u;
  uint32_t triangle = none;  ///< index into Scene::triangles
  glm::vec2 uv{0.0f};        ///< barycentric: point = (1 - u - v) a + u b + v c
  float t = std::numeric_limits<float>::infinity();

  explicit operator bool() const { return triangle != none; }
};

}  // namespace voxref
