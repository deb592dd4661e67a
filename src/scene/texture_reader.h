#pragma once
#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "scene/scene.h"
#include "scene/texture.h"

namespace voxref {

/// Value between a triangle's corners, at barycentric coordinates.
template <class T>
T interpolate(const T& a, const T& b, const T& c, const glm::vec2& uv) {
  return (1.0f - uv.x - uv.y) * a + uv.x * b + uv.y * c;
}
template <class T>
T interpolate(const std::vector<T>& attribute, const glm::uvec3& triangle, const glm::vec2& uv) {
  return interpolate(attribute[triangle.x], attribute[triangle.y], attribute[triangle.z], uv);
}

/// What of a surface point a material may read.
struct MaterialInputs {
  std::array<glm::vec2, 2> uv{};  ///< texture coordinate sets; zero where the scene has none
  glm::vec4 color{1.0f};          ///< linear; white where the scene has none
};

/// @param uv barycentric coordinates
inline MaterialInputs inputs_at(const Scene& scene, const glm::uvec3& triangle, const glm::vec2& uv) {
  MaterialInputs inputs;
  for (size_t set = 0; set < inputs.uv.size(); ++set)
    if (!scene.uv[set].empty()) inputs.uv[set] = interpolate(scene.uv[set], triangle, uv);
  if (!scene.colors.empty()) inputs.color = interpolate(scene.colors, triangle, uv);
  return inputs;
}

/// Looks a material's bindings up at one point.
struct TextureReader {
  const Scene& scene;
  const std::array<glm::vec2, 2>& uv;

  /// White where nothing is bound.
  glm::vec4 operator()(const TextureBinding& binding) const {
    const auto set = static_cast<size_t>(binding.uv_set);
    if (!binding || scene.uv[set].empty()) return glm::vec4(1.0f);
    return lookup(scene.images[static_cast<size_t>(binding.image)], binding, uv[set]);
  }
};

}  // namespace voxref
