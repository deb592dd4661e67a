#include "scene/reflectance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/reflectance_inline.h"

namespace voxref {

namespace {

using inlined::schlick_weight;

constexpr float pi = std::numbers::pi_v<float>;

// The lobe's directional albedo is linear in its two Fresnel terms:
//
//   integral of D V (f0 + f1 s) (n.l) dl = f0 A(n.v, alpha) + f1 B(n.v, alpha)
//
// and so two tables hold all materials. Both integrals are taken over microfacet normals h that the viewer sees, drawn
// with pdf D_v(h) = G1(v) (v.h) D(h) / (n.v) (Heitz 2018); what is left of the integrand is then G2 / G1(v), smooth in
// [0,1], so that a small regular grid of points integrates it. G2 / G1 = 4 (n.v)(n.l) V / G1.

struct AlbedoEntry {
  float a = 0.0f, b = 0.0f;
};
constexpr int table_cosines = 32;      // entry i: n.v = i / 31
constexpr int table_roughnesses = 32;  // entry j: perceptual roughness sqrt(alpha) = j / 31
constexpr int normals_per_side = 48;   // microfacet normals per entry: 48 x 48

/// Smith's G1 of GGX, Walter et al. 2007 eq. 34, for a cosine c > 0.
float smith_masking(float c, float alpha) {
  const float a2 = alpha * alpha;
  return 2.0f * c / (c + std::sqrt(a2 + (1.0f - a2) * c * c));
}

/// A microfacet normal that v sees, from the unit square: Heitz 2018, "Sampling the GGX distribution of visible
/// normals": stretch the view to the unit hemisphere, pick a point of the disk that the hemisphere projects to, and go
/// back.
glm::vec3 visible_normal(const glm::vec3& v, float alpha, float u1, float u2) {
  const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * v.x, alpha * v.y, v.z));
  const float length = std::hypot(stretched.x, stretched.y);
  const glm::vec3 t1 =
      length > 0.0f ? glm::vec3(-stretched.y, stretched.x, 0.0f) / length : glm::vec3(1.0f, 0.0f, 0.0f);
  const glm::vec3 t2 = glm::cross(stretched, t1);
  const float r = std::sqrt(u1), phi = 2.0f * pi * u2;
  const float x = r * std::cos(phi);
  const float blend = 0.5f * (1.0f + stretched.z);
  const float y = glm::mix(std::sqrt(std::max(0.0f, 1.0f - x * x)), r * std::sin(phi), blend);
  const glm::vec3 h = x * t1 + y * t2 + std::sqrt(std::max(0.0f, 1.0f - x * x - y * y)) * stretched;
  return glm::normalize(glm::vec3(alpha * h.x, alpha * h.y, std::max(1e-6f, h.z)));
}

AlbedoEntry integrate_albedo(float n_v, float alpha) {
  const glm::vec3 v(std::sqrt(std::max(0.0f, 1.0f - n_v * n_v)), 0.0f, n_v);
  AlbedoEntry sum;
  for (int i = 0; i < normals_per_side; ++i)
    for (int j = 0; j < normals_per_side; ++j) {
      const glm::vec3 h = visible_normal(v, alpha, (static_cast<float>(i) + 0.5f) / normals_per_side,
                                         (static_cast<float>(j) + 0.5f) / normals_per_side);
      const float v_h = glm::dot(v, h);
      const float n_l = 2.0f * v_h * h.z - n_v;
      if (n_l <= 0.0f) continue;
      const float weight = 4.0f * n_v * n_l * ggx_visibility(n_l, n_v, alpha) / smith_masking(n_v, alpha);
      sum.a += weight;
      sum.b += weight * schlick_weight(v_h);
    }
  constexpr float count = normals_per_side * normals_per_side;
  return {sum.a / count, sum.b / count};
}

/// Share of light from cosine n_v that Schlick's weight takes from a Lambertian base: (1/pi) integral s(v.h) (n.l) dl.
float integrate_layer_loss(float n_v) {
  const glm::vec3 v(std::sqrt(std::max(0.0f, 1.0f - n_v * n_v)), 0.0f, n_v);
  constexpr int side = 64;
  double sum = 0.0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      // Equal areas of the unit disk under the hemisphere are equal parts of the cosine-weighted solid angle (Malley).
      const float r2 = (static_cast<float>(i) + 0.5f) / side;
      const float phi = 2.0f * pi * (static_cast<float>(j) + 0.5f) / side;
      const glm::vec3 l(std::sqrt(r2) * std::cos(phi), std::sqrt(r2) * std::sin(phi), std::sqrt(1.0f - r2));
      sum += schlick_weight(glm::dot(v, glm::normalize(v + l)));
    }
  return static_cast<float>(sum / (side * side));
}

struct AlbedoTables {
  std::array<std::array<AlbedoEntry, table_cosines>, table_roughnesses> lobe;
  std::array<float, table_cosines> layer_loss{};
  std::array<AlbedoEntry, table_roughnesses> hemispherical_lobe;
  float hemispherical_layer_loss = 0.0f;

  AlbedoTables() {
    for (int i = 0; i < table_cosines; ++i) {
      // A viewer in the surface itself sees no microfacet; a thousandth above it stands in.
      const float n_v = std::max(static_cast<float>(i) / (table_cosines - 1), 1e-3f);
      layer_loss[i] = integrate_layer_loss(n_v);
      for (int j = 0; j < table_roughnesses; ++j) {
        const float roughness = static_cast<float>(j) / (table_roughnesses - 1);
        lobe[j][i] = integrate_albedo(n_v, std::max(roughness * roughness, Reflectance::min_alpha));
      }
    }
    average_over_hemisphere();
  }

  /// Cosine-weighted means, 2 integral x f(x) dx over [0,1], by Simpson's rule on the interpolated tables.
  void average_over_hemisphere() {
    constexpr int intervals = 2 * (table_cosines - 1);
    for (int k = 0; k <= intervals; ++k) {
      const float x = static_cast<float>(k) / intervals;
      const float weight = (k == 0 || k == intervals ? 1.0f : k % 2 ? 4.0f : 2.0f) / (3.0f * intervals) * 2.0f * x;
      hemispherical_layer_loss += weight * loss_at(x);
      for (int j = 0; j < table_roughnesses; ++j) {
        const AlbedoEntry e = along_cosine(lobe[j], x);
        hemispherical_lobe[j].a += weight * e.a;
        hemispherical_lobe[j].b += weight * e.b;
      }
    }
  }

  static AlbedoEntry blend(const AlbedoEntry& x, const AlbedoEntry& y, float t) {
    return {glm::mix(x.a, y.a, t), glm::mix(x.b, y.b, t)};
  }
  static AlbedoEntry along_cosine(const std::array<AlbedoEntry, table_cosines>& row, float n_v) {
    const float x = std::clamp(n_v, 0.0f, 1.0f) * (table_cosines - 1);
    const int i = std::min(static_cast<int>(x), table_cosines - 2);
    return blend(row[i], row[i + 1], x - static_cast<float>(i));
  }
  float loss_at(float n_v) const {
    const float x = std::clamp(n_v, 0.0f, 1.0f) * (table_cosines - 1);
    const int i = std::min(static_cast<int>(x), table_cosines - 2);
    return glm::mix(layer_loss[i], layer_loss[i + 1], x - static_cast<float>(i));
  }
  /// Row index and fraction of a width alpha.
  static std::pair<int, float> row_of(float alpha) {
    const float y = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * (table_roughnesses - 1);
    const int j = std::min(static_cast<int>(y), table_roughnesses - 2);
    return {j, y - static_cast<float>(j)};
  }
};

const AlbedoTables& tables() {
  static const AlbedoTables instance;
  return instance;
}

}  // namespace

float ggx_distribution(const glm::vec3& normal, const glm::vec3& half, float alpha) {
  return inlined::ggx_distribution(normal, half, alpha);
}

float ggx_visibility(float n_l, float n_v, float alpha) { return inlined::ggx_visibility(n_l, n_v, alpha); }

glm::vec3 evaluate(const Reflectance& r, const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in) {
  return inlined::evaluate(r, normal, out, in);
}

glm::vec3 specular_albedo(const Reflectance& r, float n_v) {
  if (!r.has_specular()) return glm::vec3(0.0f);
  const auto [j, t] = AlbedoTables::row_of(r.alpha);
  const AlbedoEntry e = AlbedoTables::blend(AlbedoTables::along_cosine(tables().lobe[j], n_v),
                                            AlbedoTables::along_cosine(tables().lobe[j + 1], n_v), t);
  return e.a * r.specular_f0 + e.b * r.specular_f1;
}

glm::vec3 diffuse_albedo(const Reflectance& r, float n_v) {
  if (r.layer_f0 == 0.0f && r.layer_f1 == 0.0f) return r.diffuse;
  return r.diffuse * (1.0f - (r.layer_f0 + r.layer_f1 * tables().loss_at(n_v)));
}

void compensate_energy(Reflectance& r, float n_v) {
  if (!r.has_specular()) return;
  Reflectance lossless;
  lossless.specular_f0 = glm::vec3(1.0f);
  lossless.alpha = r.alpha;
  const float single = specular_albedo(lossless, n_v).r;
  const glm::vec3 gain = 1.0f + r.specular_f0 * ((1.0f - single) / single);
  r.specular_f0 *= gain;
  r.specular_f1 *= gain;
}

glm::vec3 hemispherical_albedo(const Reflectance& r) {
  if (!r.has_specular() && r.layer_f0 == 0.0f && r.layer_f1 == 0.0f) return r.diffuse;
  const auto [j, t] = AlbedoTables::row_of(r.alpha);
  const AlbedoEntry e = AlbedoTables::blend(tables().hemispherical_lobe[j], tables().hemispherical_lobe[j + 1], t);
  return r.diffuse * (1.0f - (r.layer_f0 + r.layer_f1 * tables().hemispherical_layer_loss)) + e.a * r.specular_f0 +
         e.b * r.specular_f1;
}

}  // namespace voxref
