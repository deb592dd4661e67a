#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "error.h"

namespace voxref {

namespace {

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void require(bool condition, const std::string& place, const std::string& what) {
  if (!condition) throw Error(place, what);
}

std::string numbered(const char* list, size_t index) { return std::string(list) + "[" + std::to_string(index) + "]"; }

void validate_vertices(const Scene& scene) {
  const size_t n = scene.positions.size();
  require(scene.normals.size() == n, "normals", "there must be one per vertex");
  require(scene.tangents.empty() || scene.tangents.size() == n, "tangents", "there must be one per vertex, or none");
  for (const auto& uv : scene.uv)
    require(uv.empty() || uv.size() == n, "texture coordinates", "there must be one per vertex, or none");
  require(scene.colors.empty() || scene.colors.size() == n, "vertex colours", "there must be one per vertex, or none");
  for (size_t i = 0; i < n; ++i) {
    require(finite(scene.positions[i]), numbered("positions", i), "is not finite");
    require(finite(scene.normals[i]), numbered("normals", i), "is not finite");
  }
}

void validate_triangles(const Scene& scene) {
  require(scene.triangle_materials.size() == scene.triangles.size(), "triangle materials",
          "there must be one per triangle");
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      require(scene.triangles[i][k] < scene.positions.size(), numbered("triangles", i), "index beyond the vertices");
    require(scene.triangle_materials[i] < scene.materials.size(), numbered("triangles", i),
            "material beyond the materials");
  }
  size_t covered = 0;
  for (const Object& object : scene.objects) {
    require(object.first_triangle == covered, "object '" + object.name + "'", "triangle ranges must follow each other");
    require(object.triangle_count <= scene.triangles.size() - covered, "object '" + object.name + "'",
            "has triangles beyond the scene's");
    for (size_t i = covered; i < covered + object.triangle_count; ++i)
      require(scene.triangle_materials[i] == object.material, numbered("triangles", i), "material is not its object's");
    covered += object.triangle_count;
  }
  require(covered == scene.triangles.size(), "objects", "must cover all triangles");
}

void validate_binding(const Scene& scene, const TextureBinding& binding, const std::string& place) {
  if (!binding) return;
  require(static_cast<size_t>(binding.image) < scene.images.size(), place, "texture beyond the images");
  require(binding.uv_set == 0 || binding.uv_set == 1, place, "texture coordinate set must be 0 or 1");
}

void validate_materials(const Scene& scene) {
  for (size_t i = 0; i < scene.images.size(); ++i) {
    const TextureImage& image = scene.images[i];
    const size_t values = 4 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    require(image.width > 0 && image.height > 0 && image.texels8.size() + image.texels16.size() == values,
            numbered("images", i), "texel count does not match the size");
  }
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    for (const TextureBinding* binding : {&m.base_color_texture, &m.metallic_roughness_texture, &m.specular_texture,
                                          &m.specular_color_texture, &m.emission_texture, &m.normal_texture})
      validate_binding(scene, *binding, numbered("materials", i));
    require(finite(m.emission) && m.emission.r >= 0 && m.emission.g >= 0 && m.emission.b >= 0, numbered("materials", i),
            "emission must be finite and not negative");
  }
}

}  // namespace

void Bounds::add(const glm::vec3& point) {
  min = glm::min(min, point);
  max = glm::max(max, point);
}

Bounds Scene::bounds() const {
  Bounds result;
  for (const glm::uvec3& triangle : triangles)
    for (int k = 0; k < 3; ++k) result.add(positions[triangle[k]]);
  return result;
}

bool Scene::has_emission() const {
  return std::any_of(objects.begin(), objects.end(), [&](const Object& object) {
    return object.triangle_count > 0 && materials[object.material].emissive();
  });
}

void validate(const Scene& scene) {
  validate_vertices(scene);
  validate_triangles(scene);
  validate_materials(scene);
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    require(finite(light.position) && finite(light.direction) && finite(light.intensity), numbered("lights", i),
            "is not finite");
  }
}

}  // namespace voxref
