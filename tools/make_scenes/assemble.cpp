#include "make_scenes/assemble.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace voxref {

void add_object(Scene& scene, const std::string& name, const Mesh& mesh, uint32_t material) {
  const auto vertex = static_cast<uint32_t>(scene.positions.size());
  const auto triangle = static_cast<uint32_t>(scene.triangles.size());
  const auto count = static_cast<uint32_t>(mesh.triangles.size());
  scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
  scene.normals.insert(scene.normals.end(), mesh.normals.begin(), mesh.normals.end());
  for (const glm::uvec3& t : mesh.triangles) scene.triangles.push_back(t + vertex);
  scene.triangle_materials.insert(scene.triangle_materials.end(), count, material);
  scene.objects.push_back({name, triangle, count, material, false});
}

uint32_t add_material(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

Material lambertian(const std::string& name, const glm::vec3& albedo) {
  Material material;
  material.name = name;
  material.base_color = glm::vec4(albedo, 1.0f);
  material.metallic = 0.0f;
  material.specular = 0.0f;
  return material;
}

Material emitter(const std::string& name, const glm::vec3& albedo, const glm::vec3& emission) {
  Material material = lambertian(name, albedo);
  material.emission = emission;
  return material;
}

Light point_light(const std::string& name, const glm::vec3& position, const glm::vec3& intensity) {
  Light light;
  light.name = name;
  light.type = LightType::point;
  light.position = position;
  light.intensity = intensity;
  return light;
}

Light sun(const std::string& name, const glm::vec3& direction, const glm::vec3& irradiance) {
  Light light;
  light.name = name;
  light.type = LightType::directional;
  light.direction = glm::normalize(direction);
  light.intensity = irradiance;
  return light;
}

Camera camera(const std::string& name, const glm::vec3& eye, const glm::vec3& target, float yfov_degrees, float aspect,
              const glm::vec3& up) {
  Camera camera = look_at(eye, target, up, glm::radians(yfov_degrees));
  camera.name = name;
  camera.aspect = aspect;
  return camera;
}

}  // namespace voxref
