#include "scene/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

namespace voxref {
namespace {

/// Which way round a triangle shows its texture: as the image is, mirrored, or not at all (no area in the image).
enum Orientation { upright = 0, mirrored = 1, flat = 2 };

Orientation orientation(const glm::vec2& d1, const glm::vec2& d2) {
  // v points down, so a counter-clockwise triangle that shows the image upright is clockwise in (u, v).
  const double area = static_cast<double>(d1.x) * d2.y - static_cast<double>(d2.x) * d1.y;
  return area < 0.0 ? upright : area > 0.0 ? mirrored : flat;
}

/// Numbers vertices so that those of equal position, normal and texture coordinate share a number.
std::vector<uint32_t> weld(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                           std::span<const glm::vec2> uv) {
  const auto key = [&](uint32_t i) {
    const glm::vec3 &p = positions[i], &n = normals[i];
    return std::tuple(p.x, p.y, p.z, n.x, n.y, n.z, uv[i].x, uv[i].y);
  };
  std::vector<uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  std::vector<uint32_t> group(positions.size());
  uint32_t last = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && key(order[i - 1]) < key(order[i])) ++last;
    group[order[i]] = last;
  }
  return group;
}

glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0.0f && std::isfinite(length) ? v / length : glm::vec3(0.0f);
}

/// `v` projected into the plane of the unit normal, unit; zero where that is undefined.
glm::vec3 project(const glm::vec3& v, const glm::vec3& normal) {
  const glm::vec3 direction = unit_or_zero(v);  // first, so that the subtraction works on numbers near 1
  return unit_or_zero(direction - normal * glm::dot(normal, direction));
}

/// The sum of tangents of each group of equal vertices, one per orientation of the texture.
using Sums = std::vector<std::array<glm::dvec3, 2>>;

void add_triangle(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                  std::span<const glm::vec2> uv, const glm::uvec3& triangle, std::span<const uint32_t> group,
                  Sums& sums) {
  const glm::vec3 e1 = positions[triangle[1]] - positions[triangle[0]];
  const glm::vec3 e2 = positions[triangle[2]] - positions[triangle[0]];
  const glm::vec2 d1 = uv[triangle[1]] - uv[triangle[0]], d2 = uv[triangle[2]] - uv[triangle[0]];
  const Orientation side = orientation(d1, d2);
  if (side == flat) return;
  // From e1 = d1.x T + d1.y B and e2 = d2.x T + d2.y B; the positive factor 1 / |area| does not matter.
  const glm::vec3 tangent = (d2.y * e1 - d1.y * e2) * (side == upright ? -1.0f : 1.0f);
  for (int corner = 0; corner < 3; ++corner) {
    const uint32_t vertex = triangle[corner];
    const glm::vec3& normal = normals[vertex];
    const glm::vec3 to_next = project(positions[triangle[(corner + 1) % 3]] - positions[vertex], normal);
    const glm::vec3 to_last = project(positions[triangle[(corner + 2) % 3]] - positions[vertex], normal);
    const double angle = std::acos(std::clamp(static_cast<double>(glm::dot(to_next, to_last)), -1.0, 1.0));
    sums[group[vertex]][side] += angle * glm::dvec3(project(tangent, normal));
  }
}

}  // namespace

glm::vec3 perpendicular(const glm::vec3& normal, const glm::vec3& tangent) {
  const glm::vec3 projected = project(tangent, normal);
  if (projected != glm::vec3(0.0f)) return projected;
  const glm::vec3 axis = std::abs(normal.x) < 0.5f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
  return project(axis, normal);
}

TangentSpace compute_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                              std::span<const glm::vec2> uv, std::span<const glm::uvec3> triangles) {
  const std::vector<uint32_t> group = weld(positions, normals, uv);
  Sums sums(positions.size(), {glm::dvec3(0.0), glm::dvec3(0.0)});
  for (const glm::uvec3& triangle : triangles) add_triangle(positions, normals, uv, triangle, group, sums);

  TangentSpace space;
  space.triangles.assign(triangles.begin(), triangles.end());
  space.source.resize(positions.size());
  std::iota(space.source.begin(), space.source.end(), 0u);
  space.tangents.resize(positions.size());
  for (size_t i = 0; i < positions.size(); ++i)  // of vertices that no triangle uses
    space.tangents[i] = glm::vec4(perpendicular(normals[i], glm::vec3(0.0f)), 1.0f);

  constexpr uint32_t unused = ~0u;
  std::vector<std::array<uint32_t, 2>> copies(positions.size(), {unused, unused});  // of a vertex, per orientation
  for (glm::uvec3& triangle : space.triangles) {
    const Orientation side = orientation(uv[triangle[1]] - uv[triangle[0]], uv[triangle[2]] - uv[triangle[0]]);
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = triangle[corner];
      const auto& sum = sums[group[vertex]];
      const bool only_mirrored = sum[upright] == glm::dvec3(0.0) && sum[mirrored] != glm::dvec3(0.0);
      const Orientation mine = side != flat ? side : only_mirrored ? mirrored : upright;
      uint32_t& copy = copies[vertex][mine];
      if (copy == unused) {
        const bool first = copies[vertex][1 - mine] == unused;
        copy = first ? vertex : static_cast<uint32_t>(space.source.size());
        const glm::vec4 tangent(perpendicular(normals[vertex], glm::vec3(sum[mine])), mine == upright ? 1.0f : -1.0f);
        if (first) {
          space.tangents[copy] = tangent;
        } else {
          space.source.push_back(vertex);
          space.tangents.push_back(tangent);
        }
      }
      triangle[corner] = copy;
    }
  }
  return space;
}

}  // namespace voxref
