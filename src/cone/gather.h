#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "cone/cone_set.h"
#include "cone/march.h"

namespace voxref {

struct ConeOptions {
  int diffuse = 6;    ///< cones over the hemisphere, 1 to 16384
  float step = 0.5f;  ///< see MarchOptions::step
  float start =
      1.5f;  ///< voxels along the normal (times the normal's 1-norm) from the surface to a cone's apex, 0 to 8
};

struct AoOptions {
  bool enabled = false;
  float falloff = 800.0f;  ///< opacity at distance r counts 1 / (1 + falloff r / grid's longest side)
};

/// How far a cone's apex stands off a surface with this normal (unit), in voxels.
float apex_height(const glm::vec3& normal, const ConeOptions& options);

/// Where cones start.
struct GatherPoint {
  glm::vec3 position{0.0f};          ///< world
  glm::vec3 geometric_normal{0.0f};  ///< unit; the apex stands off along it, and nothing comes from behind it
  glm::vec3 shading_normal{0.0f};    ///< unit; the cones are arranged around it
  glm::vec3 aside{0.0f};             ///< world, tangential: moves the apex away from surfaces nearby
};

struct DiffuseGather {
  glm::vec3 irradiance{0.0f};  ///< W/m^2: sum of weight x radiance
  float openness = 1.0f;       ///< 1 - cosine-weighted mean opacity with distance falloff, in [0,1]; 1 unless asked for
};

/// Diffuse cones around the shading normal of a surface point (spec section 5).
DiffuseGather gather_diffuse(const Medium& medium, const std::vector<Cone>& cones, const GatherPoint& point,
                             const ConeOptions& options, const AoOptions& ao, const glm::vec3& background);

/// One cone along the mirror direction of `to_viewer` (unit), half-angle from the GGX width alpha: mean radiance,
/// before the lobe's directional albedo.
glm::vec3 gather_specular(const Medium& medium, const GatherPoint& point, const glm::vec3& to_viewer, float alpha,
                          const ConeOptions& options, const glm::vec3& background);

/// Transmittance of a cone from a surface point to `target` (world), in [0,1].
float gather_visibility(const Medium& medium, const GatherPoint& point, const glm::vec3& target, float tan_half_angle,
                        const ConeOptions& options);

}  // namespace voxref
