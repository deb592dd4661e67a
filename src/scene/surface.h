#pragma once
#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/ray.h"
#include "scene/reflectance.h"
#include "scene/scene.h"
#include "scene/texture_reader.h"

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
  MaterialPoint point(uint32_t material, const MaterialInputs& inputs) const;
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
  /// Asks the processor for what point() will read of these hits, so that it waits for all of it at once rather than
  /// for each hit in turn. Does nothing for scenes that fit in its caches.
  void prefetch(std::span<const Hit> hits) const;
  const Materials& materials() const { return materials_; }

 private:
  struct Triangle {
    glm::uvec3 corners;
    glm::vec3 geometric_normal;  // unit, of the counter-clockwise side
    glm::vec3 shading_normal;    // unit where it is the same all over, else zero
    uint32_t material;
  };
  /// All that a hit may need of a corner, side by side in one line of the cache.
  struct alignas(64) Vertex {
    glm::vec3 position{0.0f};
    glm::vec3 normal{0.0f};
    std::array<glm::vec2, 2> uv{};
    glm::vec4 tangent{0.0f};
  };
  Triangle triangle(uint32_t index) const;
  Vertex vertex(uint32_t index) const;
  std::array<glm::vec2, 2> uv(const Triangle& triangle, const glm::vec2& barycentric) const;
  glm::vec3 shading_normal(const Triangle& triangle, const Hit& hit, const std::array<glm::vec2, 2>& uv) const;

  const Scene& scene_;
  Materials materials_;
  std::vector<Triangle> triangles_;
  std::vector<Vertex> vertices_;
  std::vector<std::vector<TextureBinding>> textures_;  // that each material reads
  bool beyond_caches_ = false;
};

/// Alpha of the base colour, whatever the material's alpha mode makes of it.
float alpha(const Scene& scene, uint32_t triangle, const glm::vec2& uv);
/// Coverage of a mask alone: what the caster asks for. False in a hole.
bool covered(const Scene& scene, uint32_t triangle, const glm::vec2& uv);

}  // namespace voxref
