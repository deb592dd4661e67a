#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "cone/cone_set.h"
#include "cone/march.h"

namespace voxref {

enum class ConeOpacity : uint8_t {
  extinction,  ///< what is interpolated between texels; n short steps attenuate as one long one
  raw          ///< opacity as stored, without correction for the step, as the published shaders do
};

struct ConeOptions {
  int diffuse = 6;    ///< cones over the hemisphere, 1 to most_cones, or published_cones
  float step = 0.5f;  ///< see MarchOptions::step
  /// Voxels along the normal (of extinction times the normal's 1-norm) from the surface to a cone's apex, 0 to 16.
  float start = 1.5f;
  ConeOpacity opacity = ConeOpacity::extinction;
  std::optional<float> max_distance{};  ///< of raw cones, in the grid's longest sides; none: to the box's end
  float raw_unit = 2.0f;  ///< of raw cones: first distance, and width of the finest texels; voxels, above 0
  bool box_test = true;   ///< raw cones gather nothing where the ray from the surface misses the scene's box
};

struct AoOptions {
  bool enabled = false;
  float falloff = 800.0f;  ///< opacity at distance r counts 1 / (1 + falloff r / grid's longest side)
  float alpha = 0.0f;      ///< added to the openness
  bool normalized =
      true;  ///< the cones' occlusion is averaged; false: summed with their weights, which are pi together
  bool skip_black = false;  ///< surfaces without diffuse albedo count as open
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

/// @param occlusion sum over cones of weight x occlusion
float openness(float occlusion, const AoOptions& options);

/// Diffuse cones around the shading normal of a surface point (spec section 5).
template <class Texel>
DiffuseGather gather_diffuse(const BasicMedium<Texel>& medium, const ConeSet& cones, const GatherPoint& point,
                             const ConeOptions& options, const AoOptions& ao, const glm::vec3& background);

/// One cone along the mirror direction of `to_viewer` (unit): mean radiance, before the lobe's directional albedo.
template <class Texel>
glm::vec3 gather_specular(const BasicMedium<Texel>& medium, const GatherPoint& point, const glm::vec3& to_viewer,
                          float tan_half_angle, const ConeOptions& options, const glm::vec3& background);

/// Transmittance of a cone from a surface point to `target` (world), in [0,1].
template <class Texel>
float gather_visibility(const BasicMedium<Texel>& medium, const GatherPoint& point, const glm::vec3& target,
                        float tan_half_angle, const ConeOptions& options);

}  // namespace voxref
