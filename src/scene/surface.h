#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "scene/ray.h"
#include "scene/reflectance.h"
#include "scene/scene.h"

namespace voxref {

/// A point of a surface as one viewer sees it, textures looked up.
struct SurfacePoint {
  glm::vec3 position{0.0f};          ///< world
  glm::vec3 geometric_normal{0.0f};  ///< unit, towards the viewer
  glm::vec3 shading_normal{0.0f};    ///< unit, interpolated and mapped, bent just far enough to face the viewer
  glm::vec3 stored_normal{0.0f};     ///< unit, interpolated and mapped, as the file has it: on the front, not bent
  glm::vec3 emission{0.0f};          ///< radiance towards the viewer
  Reflectance reflectance;
  uint32_t triangle = 0, material = 0;
  bool front = true;  ///< the viewer is on the counter-clockwise side
};

/// A material's values at a point, textures looked up.
struct MaterialPoint {
  Reflectance reflectance;
  glm::vec3 emission{0.0f};    ///< radiance of the emitting side
  glm::vec3 base_color{0.0f};  ///< linear
  float opacity = 1.0f;        ///< 1 or, in the holes of a mask, 0
};

/// Evaluates a scene's materials; those that are the same all over a surface only once, when constructed. Keeps a
/// reference to the scene.
class Materials {
 public:
  explicit Materials(const Scene& scene);

  /// @param uv barycentric coordinates in the triangle, as in Hit
  MaterialPoint point(uint32_t triangle, const glm::vec2& uv) const;
  /// What the material is everywhere; null when textures or vertex colours vary it.
  const MaterialPoint* constant(uint32_t material) const {
    return constant_[material] ? &*constant_[material] : nullptr;
  }

 private:
  const Scene& scene_;
  std::vector<std::optional<MaterialPoint>> constant_;  // one per material
};

/// Looks up what rays hit. What does not change over a triangle is computed once, when constructed. Immutable; keeps a
/// reference to the scene.
class Surfaces {
 public:
  explicit Surfaces(const Scene& scene);

  /// @param to_viewer unit
  SurfacePoint point(const Hit& hit, const glm::vec3& to_viewer) const;
  const Materials& materials() const { return materials_; }

 private:
  /// All that most hits need of a triangle, side by side in one line of the cache.
  struct alignas(64) Triangle {
    glm::vec3 a, b, c;
    glm::vec3 geometric_normal;  // unit, of the counter-clockwise side
    glm::vec3 shading_normal;    // unit where it is the same all over, else zero
    uint32_t material;
  };
  glm::vec3 shading_normal(const Hit& hit, const Triangle& triangle) const;

  const Scene& scene_;
  Materials materials_;
  std::vector<Triangle> triangles_;
};

/// Alpha of the base colour, whatever the material's alpha mode makes of it.
float alpha(const Scene& scene, uint32_t triangle, const glm::vec2& uv);
/// Coverage of a mask alone: what the caster asks for. False in a hole.
bool covered(const Scene& scene, uint32_t triangle, const glm::vec2& uv);

}  // namespace voxref
