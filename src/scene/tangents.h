#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace voxref {

/// Tangents of a mesh. A vertex between triangles whose textures are mirrored images of each other needs two tangents
/// and is split: vertex i of the result is vertex source[i] of the mesh; the first ones are the mesh's own, in order.
struct TangentSpace {
  std::vector<glm::vec4> tangents;  ///< unit, perpendicular to the normal; w = +-1: bitangent = w * cross(normal, xyz)
  std::vector<uint32_t> source;
  std::vector<glm::uvec3> triangles;
};

/// Tangents for a tangent-space normal map whose file brings none, after M. S. Mikkelsen, "Simulation of wrinkled
/// surfaces revisited" (2008), on which normal-map bakers agree (MikkTSpace). The tangent points where u grows; the
/// bitangent points up the image, where glTF's v shrinks. Per triangle the position is a linear function of (u, v) and
/// gives one tangent. A vertex takes the mean over the triangles around it: each triangle's tangent is projected into
/// the plane of the vertex normal, made unit, and weighs as much as the triangle's angle at the vertex, so that
/// tessellation does not matter. Around a vertex are all triangles with a vertex of equal position, normal and texture
/// coordinate and with the same orientation of the texture; MikkTSpace also asks that they be connected by edges.
/// Triangles without texture area take what their neighbours have; a vertex with no other triangle gets any tangent.
/// @param normals unit, one per position, like `uv`
TangentSpace compute_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                              std::span<const glm::vec2> uv, std::span<const glm::uvec3> triangles);

/// The unit vector perpendicular to `normal` that is nearest to `tangent`; any perpendicular one where that is
/// undefined.
/// @param normal unit
glm::vec3 perpendicular(const glm::vec3& normal, const glm::vec3& tangent);

}  // namespace voxref
