#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/ray.h"
#include "scene/reflectance.h"
#include "scene/scene.h"

namespace voxref {

/// A point of a surface as one viewer sees it, textures looked up.
struct SurfacePoint {
  glm::vec3 position{0.0f};          ///< world
  glm::vec3 geometric_normal{0.0f};  ///< unit, towards the viewer
  glm::vec3 shading_normal{0.0f};    ///< unit, interpolated and mapped, bent just far enough to face the viewer
  glm::vec3 emission{0.0f};          ///< radiance towards the viewer
  Reflectance reflectance;
  uint32_t triangle = 0, material = 0;
  bool front = true;  ///< the viewer is on the counter-clockwise side
};

/// @param to_viewer unit
SurfacePoint surface_point(const Scene& scene, const Hit& hit, const glm::vec3& to_viewer);

/// A material's values at a point, textures looked up.
struct MaterialPoint {
  Reflectance reflectance;
  glm::vec3 emission{0.0f};    ///< radiance of the emitting side
  glm::vec3 base_color{0.0f};  ///< linear
  float opacity = 1.0f;        ///< 1 or, in the holes of a mask, 0
};

/// @param uv barycentric coordinates in the triangle, as in Hit
MaterialPoint material_point(const Scene& scene, uint32_t triangle, const glm::vec2& uv);

/// Coverage of a mask alone: what the caster asks for. False in a hole.
bool covered(const Scene& scene, uint32_t triangle, const glm::vec2& uv);

}  // namespace voxref
