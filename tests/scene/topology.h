#pragma once
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <utility>
#include <vector>

/// How a triangle soup's edges meet, by position: vertices in one place are one, whatever their normals.
struct EdgeCounts {
  size_t shared = 0;   ///< used by exactly two triangles, once in each direction
  size_t open = 0;     ///< used by one triangle
  size_t tangled = 0;  ///< anything else: used twice in one direction, or with coinciding ends
  bool closed() const { return open == 0 && tangled == 0; }
};

inline EdgeCounts count_edges(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
  using Place = std::array<float, 3>;
  const auto place = [&](uint32_t vertex) {
    const glm::vec3 p = positions[vertex] + 0.0f;  // -0 is 0
    return Place{p.x, p.y, p.z};
  };
  std::map<std::pair<Place, Place>, int> directed;
  for (const glm::uvec3& t : triangles)
    for (int k = 0; k < 3; ++k) ++directed[{place(t[k]), place(t[(k + 1) % 3])}];
  EdgeCounts counts;
  for (const auto& [edge, uses] : directed) {
    const auto back = directed.find({edge.second, edge.first});
    const int returns = back == directed.end() ? 0 : back->second;
    if (uses > 1 || edge.first == edge.second)
      ++counts.tangled;
    else if (returns == 0)
      ++counts.open;
    else if (returns == 1 && edge.first < edge.second)
      ++counts.shared;
  }
  return counts;
}

/// Volume inside a closed surface, positive when its front is outside (divergence theorem).
inline double signed_volume(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
  double sum = 0.0;
  for (const glm::uvec3& t : triangles)
    sum += glm::dot(glm::dvec3(positions[t.x]), glm::cross(glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z])));
  return sum / 6.0;
}
