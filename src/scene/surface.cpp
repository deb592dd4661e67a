#include "scene/surface.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace voxref {

namespace {

/// A shading normal that faces away from the viewer is bent until the viewer stands this high above its horizon
/// (cosine).
constexpr float least_view_cosine = 1e-3f;

/// F0 of a dielectric of refractive index 1.5, as glTF fixes it.
constexpr float dielectric_f0 = 0.04f;

/// Attribute at barycentric coordinates.
template <class T>
T interpolate(const std::vector<T>& attribute, const glm::uvec3& triangle, const glm::vec2& uv) {
  return (1.0f - uv.x - uv.y) * attribute[triangle.x] + uv.x * attribute[triangle.y] + uv.y * attribute[triangle.z];
}

/// Looks a binding up at a point of a triangle, remembering the two texture coordinate sets while it lives.
class TextureReader {
 public:
  TextureReader(const Scene& scene, const glm::uvec3& triangle, const glm::vec2& barycentric)
      : scene_(scene), triangle_(triangle), barycentric_(barycentric) {}

  /// White where nothing is bound.
  glm::vec4 operator()(const TextureBinding& binding) const {
    if (!binding || scene_.uv[binding.uv_set].empty()) return glm::vec4(1.0f);
    return lookup(scene_.images[binding.image], binding,
                  interpolate(scene_.uv[binding.uv_set], triangle_, barycentric_));
  }

 private:
  const Scene& scene_;
  const glm::uvec3& triangle_;
  const glm::vec2& barycentric_;
};

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

}  // namespace

MaterialPoint material_point(const Scene& scene, uint32_t triangle, const glm::vec2& uv) {
  const Material& m = scene.materials[scene.triangle_materials[triangle]];
  const glm::uvec3& corners = scene.triangles[triangle];
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

bool covered(const Scene& scene, uint32_t triangle, const glm::vec2& uv) {
  const Material& m = scene.materials[scene.triangle_materials[triangle]];
  const glm::uvec3& corners = scene.triangles[triangle];
  return !hole(m, base_color(scene, m, corners, uv, TextureReader(scene, corners, uv)).a);
}

SurfacePoint surface_point(const Scene& scene, const Hit& hit, const glm::vec3& to_viewer) {
  const glm::uvec3& corners = scene.triangles[hit.triangle];
  SurfacePoint point;
  point.triangle = hit.triangle;
  point.material = scene.triangle_materials[hit.triangle];
  point.position = interpolate(scene.positions, corners, hit.uv);
  const Material& m = scene.materials[point.material];

  const glm::vec3& a = scene.positions[corners.x];
  glm::vec3 geometric = glm::normalize(glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a));
  point.front = glm::dot(geometric, to_viewer) >= 0.0f;

  glm::vec3 shading = interpolate(scene.normals, corners, hit.uv);
  const float length = glm::length(shading);
  shading = length > 0.0f ? shading / length : geometric;
  if (m.normal_texture && !scene.tangents.empty()) {
    const TextureReader texture(scene, corners, hit.uv);
    shading = mapped_normal(scene, m, corners, hit.uv, shading, texture);
  }
  if (!point.front) {
    geometric = -geometric;
    shading = -shading;
  }
  const float view_cosine = glm::dot(shading, to_viewer);
  if (view_cosine < least_view_cosine)
    shading = glm::normalize(shading + (least_view_cosine - view_cosine) * to_viewer);
  point.geometric_normal = geometric;
  point.shading_normal = shading;

  const MaterialPoint material = material_point(scene, hit.triangle, hit.uv);
  point.reflectance = material.reflectance;
  if (point.front || m.double_sided) point.emission = material.emission;
  return point;
}

}  // namespace voxref
