#include "bench_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "error.h"

namespace voxref {

namespace {

constexpr uint32_t cells = 76;  // along each edge of a cube's six faces: 69,312 triangles

/// Of the ball of radius 1, in a direction.
glm::vec3 point_of_ball(const glm::vec3& direction) {
  constexpr float height = 0.1f, waves = 12.0f;
  const glm::vec3 unit = glm::normalize(direction);
  return unit * (1.0f + height * std::sin(waves * unit.x) * std::sin(waves * unit.y) * std::sin(waves * unit.z));
}

/// One entry per vertex where there are any.
template <class T>
void fill_up(std::vector<T>& attribute, size_t vertices, const T& value) {
  if (!attribute.empty()) attribute.resize(vertices, value);
}

/// The part of the ball over a cube's face, which `u`, `v` and their cross product span.
void add_face(Scene& scene, const glm::vec3& center, float radius, const glm::vec3& u, const glm::vec3& v) {
  const auto first = static_cast<uint32_t>(scene.positions.size());
  const auto at = [](uint32_t i) { return 2.0f * static_cast<float>(i) / cells - 1.0f; };
  for (uint32_t j = 0; j <= cells; ++j)
    for (uint32_t i = 0; i <= cells; ++i)
      scene.positions.push_back(center + radius * point_of_ball(glm::cross(u, v) + at(i) * u + at(j) * v));
  scene.normals.resize(scene.positions.size(), glm::vec3(0.0f));
  for (uint32_t j = 0; j < cells; ++j)
    for (uint32_t i = 0; i < cells; ++i) {
      const uint32_t a = first + j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      for (const glm::uvec3& triangle : {glm::uvec3(a, b, d), glm::uvec3(a, d, c)}) {
        const glm::vec3& corner = scene.positions[triangle.x];
        const glm::vec3 normal = glm::cross(scene.positions[triangle.y] - corner, scene.positions[triangle.z] - corner);
        for (int k = 0; k < 3; ++k) scene.normals[triangle[k]] += normal;
        scene.triangles.push_back(triangle);
      }
    }
  for (size_t i = first; i < scene.normals.size(); ++i) scene.normals[i] = glm::normalize(scene.normals[i]);
}

}  // namespace

void add_mesh(Scene& scene) {
  const Bounds bounds = scene.bounds();
  const glm::vec3 extent = bounds.extent();
  const float radius = 0.25f * std::min({extent.x, extent.y, extent.z});
  if (!(radius > 0.0f)) throw Error(scene.file, "is flat: there is no room for a mesh");
  const auto first = static_cast<uint32_t>(scene.triangles.size());
  const glm::vec3 x(1.0f, 0.0f, 0.0f), y(0.0f, 1.0f, 0.0f), z(0.0f, 0.0f, 1.0f);
  const glm::vec3 sides[6][2] = {{x, y}, {y, x}, {y, z}, {z, y}, {z, x}, {x, z}};
  for (const auto& [u, v] : sides) add_face(scene, bounds.center(), radius, u, v);
  fill_up(scene.tangents, scene.positions.size(), glm::vec4(x, 1.0f));
  for (std::vector<glm::vec2>& uv : scene.uv) fill_up(uv, scene.positions.size(), glm::vec2(0.0f));
  fill_up(scene.colors, scene.positions.size(), glm::vec4(1.0f));

  Material white;
  white.name = "bench";
  white.base_color = glm::vec4(0.7f, 0.7f, 0.7f, 1.0f);
  white.metallic = white.specular = 0.0f;
  const auto material = static_cast<uint32_t>(scene.materials.size());
  scene.materials.push_back(white);
  const auto count = static_cast<uint32_t>(scene.triangles.size()) - first;
  scene.triangle_materials.resize(scene.triangles.size(), material);
  scene.objects.push_back({"bench", first, count, material, false});
}

}  // namespace voxref
