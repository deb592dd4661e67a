#pragma once
#include <cstring>
#include <glm/geometric.hpp>
#include <optional>

#include "reference/path.h"
#include "scene/scene.h"

// Scenes of a few triangles, for answers known in closed form.
namespace voxref {

/// A Lambertian material: reflects `albedo`, emits `emission` from its front.
inline Material lambert(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0.0f)) {
  Material material;
  material.base_color = glm::vec4(albedo, 1.0f);
  material.metallic = 0.0f;
  material.specular = 0.0f;
  material.emission = emission;
  return material;
}

/// Adds a material and returns its index.
inline uint32_t add_material(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

/// Adds the parallelogram corner, corner + u, corner + u + v, corner + v, counter-clockwise seen from cross(u, v).
inline void add_quad(Scene& scene, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, uint32_t material) {
  const auto first = static_cast<uint32_t>(scene.positions.size());
  for (const glm::vec3& position : {corner, corner + u, corner + u + v, corner + v}) {
    scene.positions.push_back(position);
    scene.normals.push_back(glm::normalize(glm::cross(u, v)));
  }
  scene.objects.push_back({"quad", static_cast<uint32_t>(scene.triangles.size()), 2, material, false});
  scene.triangles.push_back({first, first + 1, first + 2});
  scene.triangles.push_back({first, first + 2, first + 3});
  scene.triangle_materials.insert(scene.triangle_materials.end(), 2, material);
}

/// Adds the inside of the cube [-1,1]^3, of one material.
inline void add_cube_interior(Scene& scene, uint32_t material) {
  const glm::vec3 x(2.0f, 0.0f, 0.0f), y(0.0f, 2.0f, 0.0f), z(0.0f, 0.0f, 2.0f), low(-1.0f), high(1.0f);
  add_quad(scene, low, y, z, material);
  add_quad(scene, low, z, x, material);
  add_quad(scene, low, x, y, material);
  add_quad(scene, high, -z, -y, material);
  add_quad(scene, high, -x, -z, material);
  add_quad(scene, high, -y, -x, material);
}

/// A square floor, y = 0, that faces up, of half-width `half`.
inline void add_floor(Scene& scene, float half, uint32_t material) {
  add_quad(scene, {-half, 0.0f, -half}, {0.0f, 0.0f, 2.0f * half}, {2.0f * half, 0.0f, 0.0f}, material);
}

/// The inside of a cube of grey walls with a point light, and a glossy block in it.
inline Scene lit_room() {
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert({0.7f, 0.6f, 0.5f})));
  Material glossy;
  glossy.metallic = 0.5f;
  glossy.roughness = 0.4f;
  add_quad(scene, {-0.9f, -0.5f, -0.4f}, {0.0f, 0.0f, 0.8f}, {0.8f, 0.0f, 0.0f}, add_material(scene, glossy));
  Light light;
  light.position = {0.5f, 0.2f, 0.3f};
  light.intensity = glm::vec3(1.0f, 0.5f, 1.0f);
  scene.lights.push_back(light);
  return scene;
}

inline View view_from(const glm::vec3& eye, const glm::vec3& target, int width, int height, float yfov = 0.8f) {
  const glm::vec3 up =
      eye.x == target.x && eye.z == target.z ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
  View view;
  view.camera = look_at(eye, target, up, yfov);
  view.width = width;
  view.height = height;
  return view;
}

/// Whether all channels are the same, bit by bit.
inline bool same_bits(const Image& a, const Image& b) {
  if (a.channels() != b.channels()) return false;
  for (const std::string& name : a.channels())
    if (std::memcmp(a.channel(name).data(), b.channel(name).data(), a.channel(name).size_bytes()) != 0) return false;
  return true;
}

inline PathResult render(const Scene& scene, const View& view, int spp, std::optional<int> max_depth = std::nullopt,
                         uint64_t seed = 0) {
  validate(scene);
  const Caster caster(scene);
  PathOptions options;
  options.spp = spp;
  options.max_depth = max_depth;
  options.seed = seed;
  return path_trace(scene, caster, view, options);
}

}  // namespace voxref
