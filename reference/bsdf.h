#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "scene/surface.h"

namespace voxref {

/// A direction drawn from a Bsdf.
struct BsdfSample {
  glm::vec3 in{0.0f};      ///< unit, away from the surface
  glm::vec3 weight{0.0f};  ///< BSDF x cosine / pdf
  float pdf = 0.0f;        ///< per solid angle
};

/// Light scattered at a surface point towards one direction. Its values are those of evaluate(); this class adds how to
/// sample them. A direction on the wrong side of the geometric surface carries nothing, whatever the shading normal
/// says.
class Bsdf {
 public:
  /// Keeps a reference to the point. @param out unit, towards where the light goes
  Bsdf(const SurfacePoint& point, const glm::vec3& out);

  /// BSDF x cosine to the shading normal, 1/sr.
  glm::vec3 value(const glm::vec3& in) const;
  /// Density with which sample() draws `in`, per solid angle; the lobes' mixture, so that it is exact for multiple
  /// importance sampling. Directions that carry nothing are counted as well.
  float pdf(const glm::vec3& in) const;
  /// Draws a direction: from the cosine lobe, or by reflection in a visible GGX normal, as often as the two lobes'
  /// albedos say. Nothing when the direction carries nothing.
  /// @param choice,u uniform in [0,1)
  std::optional<BsdfSample> sample(float choice, const glm::vec2& u) const;

  /// Whether sample() uses its `choice`.
  bool chooses() const { return specular_share_ > 0.0f && specular_share_ < 1.0f; }

 private:
  float specular_pdf(const glm::vec3& in) const;

  const SurfacePoint& point_;
  glm::vec3 out_;
  float specular_share_;  // of the samples
  bool lambertian_;       // most surfaces: what evaluate() does with those is done here, without the call
};

}  // namespace voxref
