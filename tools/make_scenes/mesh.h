#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace voxref {

/// Triangles on their own, counter-clockwise seen from the front; `normals` are unit, one per vertex, on the front
/// side.
struct Mesh {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::uvec3> triangles;
};

/// @returns its index
uint32_t add_vertex(Mesh& mesh, const glm::vec3& position, const glm::vec3& normal);
/// Appends `part` to `mesh`.
void append(Mesh& mesh, const Mesh& part);

/// Twice the triangle's area times its unit normal.
glm::dvec3 area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
/// Unit, on the side from which a, b, c run counter-clockwise.
glm::vec3 face_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
/// Sum of the triangles' areas, in double.
double area(const Mesh& mesh);

/// The same surface seen from the other side.
Mesh flipped(Mesh mesh);
/// Every triangle with three vertices of its own, which carry its face normal.
Mesh flat_shaded(const Mesh& mesh);
Mesh moved(Mesh mesh, const glm::vec3& offset);
Mesh scaled(Mesh mesh, float factor);
/// Turned by `degrees` about the axis (unit) through the origin, counter-clockwise seen from the axis's tip.
Mesh rotated(Mesh mesh, float degrees, const glm::vec3& axis);

}  // namespace voxref
