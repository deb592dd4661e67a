#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace voxref {

/// Irradiance at `point` of a plane polygon of radiance 1 that lies wholly above the receiver's horizon, on either of
/// its sides; Lambert 1760: E = 1/2 sum over edges of the angle that the edge subtends times the normal of its plane.
/// @param normal unit, of the receiver
inline double polygon_irradiance(std::span<const glm::dvec3> corners, const glm::dvec3& point,
                                 const glm::dvec3& normal) {
  double sum = 0.0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
    const glm::dvec3 across = glm::cross(a, b);
    const double length = glm::length(across);
    // The angle by its tangent: an arc cosine has no digits left where it is small.
    if (length > 0.0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(across, normal) / length;
  }
  return 0.5 * std::abs(sum);
}

}  // namespace voxref
