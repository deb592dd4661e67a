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

/// What a core has to itself of today's processors, about.
constexpr size_t bytes_of_cache = size_t{1} << 20;

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

bool hole(const Material& m, float alpha) { return m.alpha_mode == AlphaMode::mask && alpha < m.alpha_cutoff; }

/// The normal map's normal, in world space. @param normal unit, interpolated @param tangent interpolated
glm::vec3 mapped_normal(const Material& m, const glm::vec3& normal, const glm::vec4& tangent,
                        const TextureReader& texture) {
  const glm::vec3 along = glm::vec3(tangent);
  const float length = glm::length(along);
  if (!(length > 0.0f)) return normal;
  // glTF: the bitangent comes from the interpolated vectors; handedness is the same over a triangle.
  const glm::vec3 bitangent = std::copysign(1.0f, tangent.w) * glm::cross(normal, along / length);
  const glm::vec3 texel = 2.0f * glm::vec3(texture(m.normal_texture)) - 1.0f;
  const glm::vec3 mapped = m.normal_scale * (texel.x * along / length + texel.y * bitangent) + texel.z * normal;
  const float mapped_length = glm::length(mapped);
  return mapped_length > 0.0f ? mapped / mapped_length : normal;
}

/// What the material looks up; without what has no texture coordinates.
std::vector<TextureBinding> bound_textures(const Scene& scene, const Material& m) {
  std::vector<TextureBinding> bound;
  for (const TextureBinding* binding : {&m.base_color_texture, &m.metallic_roughness_texture, &m.specular_texture,
                                        &m.specular_color_texture, &m.emission_texture, &m.normal_texture})
    if (*binding && !scene.uv[static_cast<size_t>(binding->uv_set)].empty()) bound.push_back(*binding);
  return bound;
}

/// Whether the material looks the same at all points of all its surfaces; its normal map apart.
bool is_constant(const Scene& scene, Material m) {
  m.normal_texture = {};
  return scene.colors.empty() && bound_textures(scene, m).empty();
}

MaterialPoint material_point(const Scene& scene, const Material& m, const MaterialInputs& inputs) {
  const TextureReader texture{scene, inputs.uv};
  const glm::vec4 base = m.base_color * texture(m.base_color_texture) * inputs.color;
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
  for (size_t i = 0; i < constant_.size(); ++i)
    if (is_constant(scene, scene.materials[i])) constant_[i] = material_point(scene, scene.materials[i], {});
}

MaterialPoint Materials::point(uint32_t triangle, const glm::vec2& uv) const {
  const uint32_t material = scene_.triangle_materials[triangle];
  if (constant_[material]) return *constant_[material];
  return point(material, inputs_at(scene_, scene_.triangles[triangle], uv));
}

MaterialPoint Materials::point(uint32_t material, const MaterialInputs& inputs) const {
  return material_point(scene_, scene_.materials[material], inputs);
}

float alpha(const Scene& scene, uint32_t triangle, const glm::vec2& uv) {
  const Material& m = scene.materials[scene.triangle_materials[triangle]];
  const MaterialInputs inputs = inputs_at(scene, scene.triangles[triangle], uv);
  return m.base_color.a * TextureReader{scene, inputs.uv}(m.base_color_texture).a * inputs.color.a;
}

bool covered(const Scene& scene, uint32_t triangle, const glm::vec2& uv) {
  return !hole(scene.materials[scene.triangle_materials[triangle]], alpha(scene, triangle, uv));
}

Surfaces::Surfaces(const Scene& scene) : scene_(scene), materials_(scene) {
  triangles_.reserve(scene.triangles.size());
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) triangles_.push_back(triangle(i));
  vertices_.reserve(scene.positions.size());
  for (uint32_t i = 0; i < scene.positions.size(); ++i) vertices_.push_back(vertex(i));
  size_t bytes = triangles_.size() * sizeof(Triangle) + vertices_.size() * sizeof(Vertex);
  for (const Material& m : scene.materials) textures_.push_back(bound_textures(scene, m));
  for (const TextureImage& image : scene.images) bytes += image.texels8.size() + 2 * image.texels16.size();
  beyond_caches_ = bytes > bytes_of_cache;
}

Surfaces::Triangle Surfaces::triangle(uint32_t index) const {
  const glm::uvec3& corners = scene_.triangles[index];
  const glm::vec3 &a = scene_.positions[corners.x], &b = scene_.positions[corners.y], &c = scene_.positions[corners.z];
  Triangle t{};
  t.corners = corners;
  t.geometric_normal = glm::normalize(glm::cross(b - a, c - a));
  t.material = scene_.triangle_materials[index];
  const bool normal_map = scene_.materials[t.material].normal_texture && !scene_.tangents.empty();
  const glm::vec3& normal = scene_.normals[corners.x];
  if (!normal_map && normal == scene_.normals[corners.y] && normal == scene_.normals[corners.z])
    t.shading_normal = unit_or(normal, t.geometric_normal);
  return t;
}

Surfaces::Vertex Surfaces::vertex(uint32_t index) const {
  Vertex v;
  v.position = scene_.positions[index];
  v.normal = scene_.normals[index];
  if (!scene_.tangents.empty()) v.tangent = scene_.tangents[index];
  for (size_t set = 0; set < v.uv.size(); ++set)
    if (!scene_.uv[set].empty()) v.uv[set] = scene_.uv[set][index];
  return v;
}

std::array<glm::vec2, 2> Surfaces::uv(const Triangle& triangle, const glm::vec2& barycentric) const {
  const Vertex &a = vertices_[triangle.corners.x], &b = vertices_[triangle.corners.y],
               &c = vertices_[triangle.corners.z];
  return {interpolate(a.uv[0], b.uv[0], c.uv[0], barycentric), interpolate(a.uv[1], b.uv[1], c.uv[1], barycentric)};
}

void Surfaces::prefetch(std::span<const Hit> hits) const {
  if (!beyond_caches_) return;
  for (const Hit& hit : hits)
    if (hit) __builtin_prefetch(&triangles_[hit.triangle]);
  for (const Hit& hit : hits) {
    if (!hit) continue;
    const glm::uvec3& corners = triangles_[hit.triangle].corners;
    for (const uint32_t corner : {corners.x, corners.y, corners.z}) __builtin_prefetch(&vertices_[corner]);
  }
  for (const Hit& hit : hits) {
    if (!hit) continue;
    const Triangle& triangle = triangles_[hit.triangle];
    const std::vector<TextureBinding>& textures = textures_[triangle.material];
    if (textures.empty()) continue;
    const std::array<glm::vec2, 2> uv = this->uv(triangle, hit.uv);
    for (const TextureBinding& binding : textures)
      voxref::prefetch(scene_.images[static_cast<size_t>(binding.image)], binding,
                       uv[static_cast<size_t>(binding.uv_set)]);
  }
}

/// Interpolated and mapped, on the counter-clockwise side.
glm::vec3 Surfaces::shading_normal(const Triangle& triangle, const Hit& hit, const std::array<glm::vec2, 2>& uv) const {
  if (triangle.shading_normal != glm::vec3(0.0f)) return triangle.shading_normal;
  const Vertex &a = vertices_[triangle.corners.x], &b = vertices_[triangle.corners.y],
               &c = vertices_[triangle.corners.z];
  const glm::vec3 normal = unit_or(interpolate(a.normal, b.normal, c.normal, hit.uv), triangle.geometric_normal);
  const Material& m = scene_.materials[triangle.material];
  if (!m.normal_texture || scene_.tangents.empty()) return normal;
  return mapped_normal(m, normal, interpolate(a.tangent, b.tangent, c.tangent, hit.uv), TextureReader{scene_, uv});
}

SurfacePoint Surfaces::point(const Hit& hit, const glm::vec3& to_viewer) const {
  const Triangle& triangle = triangles_[hit.triangle];
  const glm::uvec3& corners = triangle.corners;
  SurfacePoint point;
  point.triangle = hit.triangle;
  point.material = triangle.material;
  point.position =
      interpolate(vertices_[corners.x].position, vertices_[corners.y].position, vertices_[corners.z].position, hit.uv);
  point.front = glm::dot(triangle.geometric_normal, to_viewer) >= 0.0f;

  MaterialInputs inputs;
  if (!textures_[triangle.material].empty()) inputs.uv = uv(triangle, hit.uv);
  const float side = point.front ? 1.0f : -1.0f;
  point.stored_normal = shading_normal(triangle, hit, inputs.uv);
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
  if (const MaterialPoint* constant = materials_.constant(triangle.material)) {
    take(*constant);
  } else {
    if (!scene_.colors.empty()) inputs.color = interpolate(scene_.colors, corners, hit.uv);
    take(materials_.point(triangle.material, inputs));
  }
  return point;
}

}  // namespace voxref
