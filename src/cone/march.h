#pragma once
#include <glm/vec3.hpp>
#include <limits>

#include "cone/medium.h"

namespace voxref {

struct MarchOptions {
  float step = 0.5f;                ///< step length in cone diameters, at least this many voxels; 0.01 to 4
  glm::vec3 background{0.0f};       ///< radiance of what leaves the grid's box
};

struct ConeSample {
  glm::vec3 radiance{0.0f};  ///< mean over the cone
  float opacity = 0.0f;      ///< in [0,1]; what is left of it saw the background
};

/// Gathers along a cone, front to back, spec section 5 (radiometric).
/// @param origin world; apex of the cone @param direction unit
/// @param normal unit, of the surface that gathers: samples whose filter would reach back to the tangent plane there are
///        taken from a finer level, so that a surface does not light itself; zero vector: no such surface
/// @param max_distance world units; the march ends there (for shadow cones) without seeing the background
ConeSample march(const Medium& medium, const glm::vec3& origin, const glm::vec3& direction, float tan_half_angle,
                 const glm::vec3& normal, const MarchOptions& options,
                 float max_distance = std::numeric_limits<float>::infinity());

/// Opacity alone, between two points.
float march_opacity(const Medium& medium, const glm::vec3& from, const glm::vec3& to, float tan_half_angle, float step);

}  // namespace voxref
