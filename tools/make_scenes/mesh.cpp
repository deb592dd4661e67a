#include "make_scenes/mesh.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

namespace voxref {

uint32_t add_vertex(Mesh& mesh, const glm::vec3& position, const glm::vec3& normal) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

void append(Mesh& mesh, const Mesh& part) {
  const auto offset = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  for (const glm::uvec3& t : part.triangles) mesh.triangles.push_back(t + offset);
}

glm::dvec3 area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::cross(b - a, c - a);
}

glm::vec3 face_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::normalize(area_vector(a, b, c));
}

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles)
    sum += 0.5 * glm::length(area_vector(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]));
  return sum;
}

Mesh flipped(Mesh mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  for (glm::vec3& n : mesh.normals) n = -n;
  return mesh;
}

Mesh flat_shaded(const Mesh& mesh) {
  Mesh flat;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    const glm::vec3 normal = face_normal(a, b, c);
    const uint32_t first = add_vertex(flat, a, normal);
    add_vertex(flat, b, normal);
    add_vertex(flat, c, normal);
    flat.triangles.emplace_back(first, first + 1, first + 2);
  }
  return flat;
}

Mesh moved(Mesh mesh, const glm::vec3& offset) {
  for (glm::vec3& p : mesh.positions) p += offset;
  return mesh;
}

Mesh scaled(Mesh mesh, float factor) {
  for (glm::vec3& p : mesh.positions) p *= factor;
  return mesh;
}

Mesh rotated(Mesh mesh, float degrees, const glm::vec3& axis) {
  const glm::dmat3 rotation(glm::rotate(glm::dmat4(1.0), glm::radians(double(degrees)), glm::dvec3(axis)));
  for (glm::vec3& p : mesh.positions) p = rotation * glm::dvec3(p);
  for (glm::vec3& n : mesh.normals) n = glm::normalize(rotation * glm::dvec3(n));
  return mesh;
}

}  // namespace voxref
