#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "scene/scene.h"
#include "scene/texture.h"

namespace voxref {

/// A vertex attribute at barycentric coordinates.
template <class T>
T interpolate(const std::vector<T>& attribute, const glm::uvec3& triangle, const glm::vec2& uv) {
  return (1.0f - uv.x - uv.y) * attribute[triangle.x] + uv.x * attribute[triangle.y] + uv.y * attribute[triangle.z];
}

/// Looks bindings up at one point of a triangle. Keeps references to its arguments.
class TextureReader {
 public:
  TextureReader(const Scene& scene, const glm::uvec3& triangle, const glm::vec2& barycentric)
      : scene_(scene), triangle_(triangle), barycentric_(barycentric) {}

  /// White where nothing is bound.
  glm::vec4 operator()(const TextureBinding& binding) const {
    if (!binding || scene_.uv[binding.uv_set].empty()) return glm::vec4(1.0f);
    return lookup(scene_.images[binding.image], binding,
                  interpolate(scene_.uv[binding.uv_set], triangle_, barycentric_));
  }

 private:
  const Scene& scene_;
  const glm::uvec3& triangle_;
  const glm::vec2& barycentric_;
};

}  // namespace voxref
