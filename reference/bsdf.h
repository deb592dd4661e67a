#pragma once
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>

#include "reference/warp.h"
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
  Bsdf(const SurfacePoint& point, const glm::vec3& out)
      : point_(point),
        out_(out),
        specular_share_(point.reflectance.has_specular() ? specular_share() : 0.0f),
        lambertian_(specular_share_ == 0.0f && point.reflectance.layer_f0 == 0.0f &&
                    point.reflectance.layer_f1 == 0.0f) {}

  /// BSDF x cosine to the shading normal, 1/sr.
  glm::vec3 value(const glm::vec3& in) const {
    const float cosine = glm::dot(point_.shading_normal, in);
    if (cosine <= 0.0f || glm::dot(point_.geometric_normal, in) <= 0.0f) return glm::vec3(0.0f);
    if (lambertian_) return cosine * std::numbers::inv_pi_v<float> * point_.reflectance.diffuse;
    return cosine * evaluate(point_.reflectance, point_.shading_normal, out_, in);
  }
  /// Density with which sample() draws `in`, per solid angle; the lobes' mixture, so that it is exact for multiple
  /// importance sampling. Directions that carry nothing are counted as well.
  float pdf(const glm::vec3& in) const;
  /// Draws a direction: from the cosine lobe, or by reflection in a visible GGX normal, as often as the two lobes'
  /// albedos say. Nothing when the direction carries nothing.
  /// @param choice,u uniform in [0,1)
  std::optional<BsdfSample> sample(float choice, const glm::vec2& u) const {
    return lambertian_ ? sample_lambertian(u) : sample_lobes(choice, u);
  }

  /// Whether sample() uses its `choice`.
  bool chooses() const { return specular_share_ > 0.0f && specular_share_ < 1.0f; }

 private:
  float specular_share() const;
  float specular_pdf(const glm::vec3& in) const;
  std::optional<BsdfSample> sample_lobes(float choice, const glm::vec2& u) const;
  std::optional<BsdfSample> sample_lambertian(const glm::vec2& u) const {
    const glm::vec3 local = cosine_hemisphere(u);
    // Filled in place: a copy of what was just written in pieces makes the processor wait.
    std::optional<BsdfSample> sample(std::in_place);
    sample->in = Frame(point_.shading_normal).to_world(local);
    sample->weight = point_.reflectance.diffuse;  // albedo / pi x cosine over cosine / pi
    sample->pdf = local.z * std::numbers::inv_pi_v<float>;
    if (local.z <= 0.0f || glm::dot(point_.geometric_normal, sample->in) <= 0.0f) sample.reset();
    return sample;
  }

  const SurfacePoint& point_;
  glm::vec3 out_;
  float specular_share_;  // of the samples
  bool lambertian_;       // most surfaces: what evaluate() does with those is done here, inline
};

}  // namespace voxref
