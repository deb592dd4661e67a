#include "cone/clearance.h"

#include <glm/geometric.hpp>

namespace voxref {
namespace {

/// Unit normal of a triangle on the side that a ray comes from.
glm::vec3 facing_normal(const Scene& scene, uint32_t triangle, const glm::vec3& direction) {
  const glm::uvec3& corners = scene.triangles[triangle];
  const glm::vec3& a = scene.positions[corners.x];
  const glm::vec3 normal = glm::normalize(glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a));
  return glm::dot(normal, direction) > 0.0f ? -normal : normal;
}

}  // namespace

glm::vec3 clearance(const Scene& scene, const Caster& caster, const glm::vec3& position, const glm::vec3& normal,
                    const ConeOptions& options, float voxel) {
  // A wall may be turned by 45 degrees against the nearest ray, and its 1-norm be sqrt(3): 2.5 times the start at most.
  const float farthest = 2.5f * options.start * voxel;
  const glm::mat3 frame = frame_around(normal);
  glm::vec3 move(0.0f);
  for (const glm::vec3& along : {frame[0], -frame[0], frame[1], -frame[1]}) {
    Ray ray = caster.leave(position, normal, along);
    ray.tmax = farthest;
    const Hit hit = caster.closest(ray);
    if (!hit) continue;
    const glm::vec3 wall = facing_normal(scene, hit.triangle, along);
    const float distance = glm::dot(move, wall) - hit.t * glm::dot(along, wall);
    const float missing = apex_height(wall, options) * voxel - distance;
    if (missing > 0.0f) move += missing * (wall - glm::dot(wall, normal) * normal);
  }
  return move;
}

}  // namespace voxref
