#include "reference/bsdf.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "image/image.h"

namespace voxref {

namespace {

// Where both lobes are there each gets at least a tenth of the samples: the albedos are those of the whole hemisphere,
// and what a lobe gives in one direction may be far more than its share.
constexpr float least_share = 0.1f;

}  // namespace

/// Where there is a specular lobe.
float Bsdf::specular_share() const {
  const Reflectance& reflectance = point_.reflectance;
  if (!reflectance.has_diffuse()) return 1.0f;
  const float n_out = glm::dot(point_.shading_normal, out_);
  const float specular = luminance(specular_albedo(reflectance, n_out));
  const float diffuse = luminance(diffuse_albedo(reflectance, n_out));
  const float share = specular / (specular + diffuse);
  return std::isfinite(share) ? std::clamp(share, least_share, 1.0f - least_share) : 0.5f;
}

// Density of reflecting `out` in a visible normal: G1 D (o.h) / o.n, over the Jacobian 4 (o.h) of the reflection (Heitz
// 2018 eq. 17), with Smith's G1 = 2 o.n / (o.n + sqrt(alpha^2 + (1 - alpha^2) (o.n)^2)).
float Bsdf::specular_pdf(const glm::vec3& in) const {
  const glm::vec3& normal = point_.shading_normal;
  const float alpha = point_.reflectance.alpha;
  const float n_out = glm::dot(normal, out_);
  const float root = std::sqrt(alpha * alpha + (1.0f - alpha * alpha) * n_out * n_out);
  return ggx_distribution(normal, glm::normalize(out_ + in), alpha) / (2.0f * (n_out + root));
}

float Bsdf::pdf(const glm::vec3& in) const {
  const float cosine = glm::dot(point_.shading_normal, in);
  if (cosine <= 0.0f) return 0.0f;
  float density = 0.0f;
  if (specular_share_ < 1.0f) density += (1.0f - specular_share_) * cosine * std::numbers::inv_pi_v<float>;
  if (specular_share_ > 0.0f) density += specular_share_ * specular_pdf(in);
  return density;
}

std::optional<BsdfSample> Bsdf::sample_lobes(float choice, const glm::vec2& u) const {
  const Frame frame(point_.shading_normal);
  BsdfSample sample;
  if (choice < specular_share_) {
    const glm::vec3 half = frame.to_world(visible_ggx_normal(frame.to_local(out_), point_.reflectance.alpha, u));
    sample.in = glm::normalize(2.0f * glm::dot(out_, half) * half - out_);
  } else {
    sample.in = frame.to_world(cosine_hemisphere(u));
  }
  sample.pdf = pdf(sample.in);
  if (!(sample.pdf > 0.0f)) return std::nullopt;
  const glm::vec3 value = this->value(sample.in);
  if (value == glm::vec3(0.0f)) return std::nullopt;
  sample.weight = value / sample.pdf;
  return sample;
}

}  // namespace voxref
