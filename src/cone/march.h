#pragma once
#include <glm/vec3.hpp>
#include <limits>

#include "cone/medium.h"

namespace voxref {

struct MarchOptions {
  float step = 0.5f;           ///< step length in cone diameters (texels, where those are narrower); 0.01 to 4
  glm::vec3 background{0.0f};  ///< radiance of what leaves the grid's box
  float falloff = 0.0f;        ///< of ConeSample::occlusion, 1/voxel; 0: as opacity
};

/// The plane of the surface that gathers. A texel that it passes through holds that surface's own light and opacity, so
/// that a sample is taken from a level fine enough for its filter, 1.5 texels to each side, to stay above the plane.
struct OwnPlane {
  glm::vec3 normal{0.0f};  ///< unit; zero vector: there is no such surface
  float height = 0.0f;     ///< of the cone's apex above the plane, voxels
};

struct ConeSample {
  glm::vec3 radiance{0.0f};  ///< mean over the cone, W/(sr m^2)
  float opacity = 0.0f;      ///< in [0,1]; what is left of it saw the background
  float occlusion = 0.0f;    ///< opacity in which what lies at distance r voxels counts 1 / (1 + falloff r)
};

/// Gathers along a cone, front to back, spec section 5 (radiometric).
/// @param origin world; apex of the cone @param direction unit @param tan_half_angle at least 0
/// @param max_distance world units; the march ends there (for shadow cones) without seeing the background
ConeSample march(const Medium& medium, const glm::vec3& origin, const glm::vec3& direction, float tan_half_angle,
                 const OwnPlane& own, const MarchOptions& options,
                 float max_distance = std::numeric_limits<float>::infinity());

/// Opacity alone, between two points.
float march_opacity(const Medium& medium, const glm::vec3& from, const glm::vec3& to, float tan_half_angle, float step);

}  // namespace voxref
