#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "cone/cone_set.h"
#include "cone/march.h"

namespace voxref {

struct ConeOptions {
  int diffuse = 6;      ///< cones over the hemisphere
  float step = 0.5f;    ///< see MarchOptions::step
  float start = 1.5f;   ///< voxels along the normal (times the normal's 1-norm) from the surface to a cone's apex
};

struct AoOptions {
  bool enabled = false;
  float falloff = 800.0f;  ///< opacity at distance r counts 1 / (1 + falloff r / grid side)
};

struct DiffuseGather {
  glm::vec3 irradiance{0.0f};   ///< W/m^2: sum of weight x radiance
  float openness = 1.0f;        ///< 1 - cosine-weighted mean opacity with distance falloff, in [0,1]; 1 unless asked for
};

/// Diffuse cones around `normal` at a surface point (spec section 5).
DiffuseGather gather_diffuse(const Medium& medium, const std::vector<Cone>& cones, const glm::vec3& position,
                             const glm::vec3& normal, const ConeOptions& options, const AoOptions& ao,
                             const glm::vec3& background);

/// One cone along the mirror direction, half-angle from alpha: mean radiance, before the lobe's directional albedo.
glm::vec3 gather_specular(const Medium& medium, const glm::vec3& position, const glm::vec3& normal,
                          const glm::vec3& to_viewer, float alpha, const ConeOptions& options,
                          const glm::vec3& background);

}  // namespace voxref
