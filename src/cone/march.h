#pragma once
#include <glm/vec3.hpp>
#include <limits>

#include "cone/medium.h"

namespace voxref {

struct MarchOptions {
  float step = 0.5f;           ///< step length in texels, which are `texel` cone diameters (one voxel at least) wide
  glm::vec3 background{0.0f};  ///< radiance of what leaves the grid's box
  float falloff = 0.0f;        ///< of ConeSample::occlusion, 1/voxel; 0: as opacity
  float texel = 1.0f;          ///< side of the texels that are sampled over the cone's diameter, see Cone::texel
};

/// The surface that gathers. A texel that it passes through holds that surface's own light and opacity, so that a
/// cone's apex stands off it, and a sample is taken from a level fine enough for its filter, 1.5 texels to each side,
/// to stay above its plane. What a cone meets further away must not seem to have moved by as much: a march follows the
/// line from the surface point itself as soon as that is as far above the plane as the apex.
struct OwnPlane {
  glm::vec3 normal{0.0f};  ///< unit; zero vector: there is no such surface
  glm::vec3 lift{0.0f};    ///< from the surface point to the cone's apex, voxels; not below the plane
};

struct ConeSample {
  glm::vec3 radiance{0.0f};  ///< mean over the cone, W/(sr m^2)
  float opacity = 0.0f;      ///< in [0,1]; what is left of it saw the background
  float occlusion = 0.0f;    ///< opacity in which what lies at distance r voxels counts 1 / (1 + falloff r)
};

/// Gathers along a cone, front to back, spec section 5 (radiometric).
/// @param origin world; apex of the cone @param direction unit @param tan_half_angle at least 0
/// @param max_distance world units; the march ends there (for shadow cones) without seeing the background
template <class Texel>
ConeSample march(const BasicMedium<Texel>& medium, const glm::vec3& origin, const glm::vec3& direction,
                 float tan_half_angle, const OwnPlane& own, const MarchOptions& options,
                 float max_distance = std::numeric_limits<float>::infinity());

/// Opacity alone, between two points.
template <class Texel>
float march_opacity(const BasicMedium<Texel>& medium, const glm::vec3& from, const glm::vec3& to, float tan_half_angle,
                    float step);

}  // namespace voxref
