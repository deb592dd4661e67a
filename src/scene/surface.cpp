#include "scene/surface.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/texture_reader.h"

namespace voxref {

namespace {

/// A shading normal that faces away from the viewer is bent until the viewer stands this high above its horizon
/// (cosine).
constexpr float least_view_cosine = 1e-3f;

/// F0 of a dielectric of refractive index 1.5, as glTF fixes it.
constexpr float dielectric_f0 = 0.04f;

float clamped_alpha(float perceptual_roughness) {
  return std::clamp(perceptual_roughness * perceptual_roughness, Reflectance::min_alpha, 1.0f);
}

// glTF 2.0 appendix B with KHR_materials_specular: the material is the mix, by `metallic`, of a dielectric
//   (1 - w max F_d) base/pi + w F_d D V,   F_d = Schlick(min(0.04 colour, 1)), w = specular
// and a metal F_m D V, F_m = Schlick(base). Both F are linear in Schlick's weight s, so their mix is one lobe.
Reflectance metallic_roughness(const Material& m, const glm::vec3& base, const TextureReader& texture) {
  const glm::vec4 metal_rough = texture(m.metallic_roughness_texture);
  const float metallic = m.metallic * metal_rough.b;
  const float specular = m.specular * texture(m.specular_texture).a;
  const glm::vec3 f0 =
      glm::min(dielectric_f0 * m.specular_color * glm::vec3(texture(m.specular_color_texture)), glm::vec3(1.0f));
  const float strongest_f0 = std::max({f0.r, f0.g, f0.b});
  Reflectance r;
  r.diffuse = (1.0f - metallic) * base;
  r.layer_f0 = specular * strongest_f0;
  r.layer_f1 = specular * (1.0f - strongest_f0);
  r.specular_f0 = (1.0f - metallic) * specular * f0 + metallic * base;
  r.specular_f1 = (1.0f - metallic) * specular * (1.0f - f0) + metallic * (1.0f - base);
  r.alpha = clamped_alpha(m.roughness * metal_rough.g);
  return r;
}

// KHR_materials_pbrSpecularGlossiness: diffuse (1 - max F0) under a lobe with the given F0.
Reflectance specular_glossiness(const Material& m, const glm::vec3& base, const TextureReader& texture) {
  const glm::vec4 specular_gloss = texture(m.specular_color_texture);
  const glm::vec3 f0 = m.specular_color * glm::vec3(specular_gloss);
  const float strongest_f0 = std::max({f0.r, f0.g, f0.b});
  Reflectance r;
  r.diffuse = (1.0f - strongest_f0) * base;
  r.layer_f0 = strongest_f0;
  r.layer_f1 = 1.0f - strongest_f0;
  r.specular_f0 = f0;
  r.specular_f1 = 1.0f - f0;
  r.alpha = clamped_alpha(1.0f - m.glossiness * specular_gloss.a);
  return r;
}

glm::vec4 base_color(const Scene& scene, const Material& m, const glm::uvec3& triangle, const glm::vec2& uv,
                     const TextureReader& texture) {
  glm::vec4 base = m.base_color * texture(m.base_color_texture);
  if (!scene.colors.empty()) base *= interpolate(scene.colors, triangle, uv);
  return base;
}

bool hole(const Material& m, float alpha) { return m.alpha_mode == AlphaMode::mask && alpha < m.alpha_cutoff; }

/// The normal map's normal, in world space. @param normal unit, interpolated
glm::vec3 mapped_normal(const Scene& scene, const Material& m, const glm::uvec3& triangle, const glm::vec2& uv,
                        const glm::vec3& normal, const TextureReader& texture) {
  const glm::vec4 tangent = interpolate(scene.tangents, triangle, uv);
  const glm::vec3 along = glm::vec3(tangent);
  const float length = glm::length(along);
  if (!(length > 0.0f)) return normal;
  // glTF: the bitangent comes from the interpolated vectors; handedness is the same over a triangle.
  const glm::vec3 bitangent = scene.tangents[triangle.x].w * glm::cross(normal, along / length);
  const glm::vec3 texel = 2.0f * glm::vec3(texture(m.normal_texture)) - 1.0f;
  const glm::vec3 mapped = m.normal_scale * (texel.x * along / length + texel.y * bitangent) + texel.z * normal;
  const float mapped_length = glm::length(mapped);
  return mapped_length > 0.0f ? mapped / mapped_length : normal;
}

/// Whether the material looks the same at all points of all its surfaces; its normal map apart.
bool is_constant(const Scene& scene, const Material& m) {
  if (!scene.colors.empty()) return false;
  for (const TextureBinding* binding : {&m.base_color_texture, &m.metallic_roughness_texture, &m.specular_texture,
                                        &m.specular_color_texture, &m.emission_texture})
    if (*binding && !scene.uv[binding->uv_set].empty()) return false;
  return true;
}

MaterialPoint material_point(const Scene& scene, const Material& m, const glm::uvec3& corners, const glm::vec2& uv) {
  const TextureReader texture(scene, corners, uv);
  const glm::vec4 base = base_color(scene, m, corners, uv, texture);
  MaterialPoint point;
  point.base_color = glm::vec3(base);
  point.opacity = hole(m, base.a) ? 0.0f : 1.0f;
  point.reflectance = m.workflow == Workflow::metallic_roughness ? metallic_roughness(m, point.base_color, texture)
                                                                 : specular_glossiness(m, point.base_color, texture);
  if (m.emissive()) point.emission = m.emission * glm::vec3(texture(m.emission_texture));
  return point;
}

/// `normal` made unit; `fallback` where it has no direction.
glm::vec3 unit_or(const glm::vec3& normal, const glm::vec3& fallback) {
  const float length = glm::length(normal);
  return length > 0.0f ? normal / length : fallback;
}

}  // namespace

Materials::Materials(const Scene& scene) : scene_(scene), constant_(scene.materials.size()) {
  // A constant material reads nothing of the triangle, so that any will do.
  for (size_t i = 0; i < constant_.size(); ++i)
    if (is_constant(scene, scene.materials[i]))
      constant_[i] = material_point(scene, scene.materials[i], glm::uvec3(0), glm::vec2(0.0f));
}

MaterialPoint Materials::point(uint32_t triangle, const glm::vec2& uv) const {
  const uint32_t material = scene_.triangle_materials[triangle];
  if (constant_[material]) return *constant_[material];
  return material_point(scene_, scene_.materials[material], scene_.triangles[triangle], uv);
}

float alpha(const Scene& scene, uint32_t triangle, const glm::vec2& uv) {
  const glm::uvec3& corners = scene.triangles[triangle];
  return base_color(scene, scene.materials[scene.triangle_materials[triangle]], corners, uv,
                    TextureReader(scene, corners, uv))
      .a;
}

bool covered(const Scene& scene, uint32_t triangle, const glm::vec2& uv) {
  return !hole(scene.materials[scene.triangle_materials[triangle]], alpha(scene, triangle, uv));
}

Surfaces::Surfaces(const Scene& scene) : scene_(scene), materials_(scene) {
  triangles_.reserve(scene.triangles.size());
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const glm::uvec3& corners = scene.triangles[i];
    Triangle t{};
    t.a = scene.positions[corners.x];
    t.b = scene.positions[corners.y];
    t.c = scene.positions[corners.z];
    t.geometric_normal = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
    t.material = scene.triangle_materials[i];
    const bool normal_map = scene.materials[t.material].normal_texture && !scene.tangents.empty();
    const glm::vec3& normal = scene.normals[corners.x];
    if (!normal_map && normal == scene.normals[corners.y] && normal == scene.normals[corners.z])
      t.shading_normal = unit_or(normal, t.geometric_normal);
    triangles_.push_back(t);
  }
}

/// Interpolated and mapped, on the counter-clockwise side.
glm::vec3 Surfaces::shading_normal(const Hit& hit, const Triangle& triangle) const {
  const glm::uvec3& corners = scene_.triangles[hit.triangle];
  const glm::vec3 normal = unit_or(interpolate(scene_.normals, corners, hit.uv), triangle.geometric_normal);
  const Material& m = scene_.materials[triangle.material];
  if (!m.normal_texture || scene_.tangents.empty()) return normal;
  return mapped_normal(scene_, m, corners, hit.uv, normal, TextureReader(scene_, corners, hit.uv));
}

SurfacePoint Surfaces::point(const Hit& hit, const glm::vec3& to_viewer) const {
  const Triangle& triangle = triangles_[hit.triangle];
  SurfacePoint point;
  point.triangle = hit.triangle;
  point.material = triangle.material;
  point.position = (1.0f - hit.uv.x - hit.uv.y) * triangle.a + hit.uv.x * triangle.b + hit.uv.y * triangle.c;
  point.front = glm::dot(triangle.geometric_normal, to_viewer) >= 0.0f;

  const float side = point.front ? 1.0f : -1.0f;
  const bool varies = triangle.shading_normal == glm::vec3(0.0f);
  point.stored_normal = varies ? shading_normal(hit, triangle) : triangle.shading_normal;
  glm::vec3 shading = side * point.stored_normal;
  const float view_cosine = glm::dot(shading, to_viewer);
  if (view_cosine < least_view_cosine)
    shading = glm::normalize(shading + (least_view_cosine - view_cosine) * to_viewer);
  point.geometric_normal = side * triangle.geometric_normal;
  point.shading_normal = shading;

  const auto take = [&](const MaterialPoint& material) {
    point.reflectance = material.reflectance;
    if (point.front || scene_.materials[triangle.material].double_sided) point.emission = material.emission;
  };
  if (const MaterialPoint* constant = materials_.constant(triangle.material))
    take(*constant);
  else
    take(materials_.point(hit.triangle, hit.uv));
  return point;
}

}  // namespace voxref
