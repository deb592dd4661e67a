#pragma once
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>

#include "reference/lanes.h"
#include "reference/warp.h"
#include "scene/reflectance_inline.h"
#include "scene/surface.h"

namespace voxref {

/// A direction drawn from a Bsdf.
struct BsdfSample {
  glm::vec3 in{0.0f};      ///< unit, away from the surface
  glm::vec3 weight{0.0f};  ///< BSDF x cosine / pdf; zero where the direction carries nothing
  float pdf = 0.0f;        ///< per solid angle

  /// Whether the direction carries anything.
  explicit operator bool() const { return weight != glm::vec3(0.0f); }
};

/// Share of the samples that shall go to the specular lobe, where there is one: as the two lobes' albedos stand.
/// @param n_out cosine of the direction in which the light leaves
float specular_share_of(const Reflectance& reflectance, float n_out);
inline float specular_share(const Reflectance& reflectance, float n_out) {
  return reflectance.has_specular() ? specular_share_of(reflectance, n_out) : 0.0f;
}

/// Light scattered at a surface point towards one direction. Its values are those of evaluate(); this class adds how to
/// sample them. A direction on the wrong side of the geometric surface carries nothing, whatever the shading normal
/// says. Without branches, see lanes.h.
class Bsdf {
 public:
  /// @param out unit, towards where the light goes
  Bsdf(const SurfacePoint& point, const glm::vec3& out)
      : Bsdf(point.reflectance, point.shading_normal, point.geometric_normal, out,
             specular_share(point.reflectance, glm::dot(point.shading_normal, out)), is_lambertian(point.reflectance)) {
  }
  /// @param lambertian promises is_lambertian(reflectance), to save time
  Bsdf(const Reflectance& reflectance, const glm::vec3& normal, const glm::vec3& geometric_normal, const glm::vec3& out,
       float specular_share, bool lambertian)
      : reflectance_(reflectance),
        normal_(normal),
        geometric_normal_(geometric_normal),
        out_(out),
        specular_share_(specular_share),
        lambertian_(lambertian) {}

  static bool is_lambertian(const Reflectance& r) {
    return !r.has_specular() && r.layer_f0 == 0.0f && r.layer_f1 == 0.0f;
  }

  /// BSDF x cosine to the shading normal, 1/sr.
  glm::vec3 value(const glm::vec3& in) const {
    const float cosine = glm::dot(normal_, in);
    const glm::vec3 f = cosine * (lambertian_ ? reflectance_.diffuse / std::numbers::pi_v<float>
                                              : inlined::evaluate(reflectance_, normal_, out_, in));
    return select((cosine > 0.0f) & (glm::dot(geometric_normal_, in) > 0.0f), f, glm::vec3(0.0f));
  }
  /// Density with which sample() draws `in`, per solid angle; the lobes' mixture, so that it is exact for multiple
  /// importance sampling. Directions that carry nothing are counted as well.
  float pdf(const glm::vec3& in) const {
    const float cosine = glm::dot(normal_, in);
    float density = cosine * std::numbers::inv_pi_v<float>;
    if (!lambertian_) density = (1.0f - specular_share_) * density + specular_share_ * specular_pdf(in);
    return cosine > 0.0f ? density : 0.0f;
  }
  /// Draws a direction: from the cosine lobe, or by reflection in a visible GGX normal.
  /// @param choice,u uniform in [0,1)
  BsdfSample sample(float choice, const glm::vec2& u) const {
    const Frame frame(normal_);
    const glm::vec3 diffuse = frame.to_world(cosine_hemisphere(u));
    const glm::vec3 in = select(!lambertian_ & (choice < specular_share_), mirrored(frame, u), diffuse);
    const float density = pdf(in);
    return {{in.x, in.y, in.z}, select(density > 0.0f, value(in) / density, glm::vec3(0.0f)), density};
  }

 private:
  glm::vec3 mirrored(const Frame& frame, const glm::vec2& u) const {
    const glm::vec3 half = frame.to_world(visible_ggx_normal(frame.to_local(out_), reflectance_.alpha, u));
    return glm::normalize(2.0f * glm::dot(out_, half) * half - out_);
  }
  /// Density of reflecting `out` in a visible normal: G1 D (o.h) / o.n, over the Jacobian 4 (o.h) of the reflection
  /// (Heitz 2018 eq. 17), with Smith's G1 = 2 o.n / (o.n + sqrt(alpha^2 + (1 - alpha^2) (o.n)^2)).
  float specular_pdf(const glm::vec3& in) const {
    const float alpha = reflectance_.alpha;
    const float n_out = glm::dot(normal_, out_);
    const float root = std::sqrt(alpha * alpha + (1.0f - alpha * alpha) * n_out * n_out);
    return inlined::ggx_distribution(normal_, glm::normalize(out_ + in), alpha) / (2.0f * (n_out + root));
  }

  Reflectance reflectance_;
  glm::vec3 normal_, geometric_normal_, out_;
  float specular_share_;  // of the samples
  bool lambertian_;
};

}  // namespace voxref
