#pragma once
#include <cmath>
#include <glm/vec3.hpp>

#include "scene/surface.h"

// Reflectances at a point whose normals are +z.
namespace voxref {

inline SurfacePoint flat_point(const Reflectance& reflectance) {
  SurfacePoint point;
  point.geometric_normal = point.shading_normal = {0.0f, 0.0f, 1.0f};
  point.reflectance = reflectance;
  return point;
}

inline Reflectance metal(float alpha, float f0 = 1.0f) {
  Reflectance reflectance;
  reflectance.specular_f0 = glm::vec3(f0);
  reflectance.specular_f1 = glm::vec3(1.0f - f0);
  reflectance.alpha = alpha;
  return reflectance;
}

/// glTF's plastic: a 4 % lobe over a base.
inline Reflectance plastic(float alpha, const glm::vec3& base = glm::vec3(0.9f)) {
  Reflectance reflectance = metal(alpha, 0.04f);
  reflectance.diffuse = base;
  reflectance.layer_f0 = 0.04f;
  reflectance.layer_f1 = 0.96f;
  return reflectance;
}

/// @param cosine with +z @param angle around it, radians
inline glm::dvec3 direction(double cosine, double angle) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

}  // namespace voxref
