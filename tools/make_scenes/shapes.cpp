#include "make_scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <utility>

#include "error.h"

namespace voxref {
namespace {

/// Unit directions, joined into triangles.
struct DirectionMesh {
  std::vector<glm::dvec3> directions;
  std::vector<glm::uvec3> triangles;
};

/// Cuts every triangle in four at its edges' midpoints, pushed out to distance 1; neighbours share them.
DirectionMesh subdivided(DirectionMesh mesh, int subdivisions) {
  if (subdivisions < 0 || subdivisions > 8) throw Error("subdivisions", "must be in [0, 8]");
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> midpoints;
    const auto midpoint = [&](uint32_t a, uint32_t b) {
      const auto [entry, added] =
          midpoints.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.directions.size()));
      if (added) mesh.directions.push_back(glm::normalize(mesh.directions[a] + mesh.directions[b]));
      return entry->second;
    };
    std::vector<glm::uvec3> quarters;
    quarters.reserve(4 * mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles) {
      const uint32_t ab = midpoint(t.x, t.y), bc = midpoint(t.y, t.z), ca = midpoint(t.z, t.x);
      quarters.insert(quarters.end(), {{t.x, ab, ca}, {t.y, bc, ab}, {t.z, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(quarters);
  }
  return mesh;
}

/// Corners (0, +-1, +-phi) and their cyclic permutations, phi the golden ratio.
DirectionMesh icosahedron_directions() {
  const double phi = std::numbers::phi;
  DirectionMesh mesh;
  for (const glm::dvec3& corner : std::initializer_list<glm::dvec3>{{-1, phi, 0},
                                                                    {1, phi, 0},
                                                                    {-1, -phi, 0},
                                                                    {1, -phi, 0},
                                                                    {0, -1, phi},
                                                                    {0, 1, phi},
                                                                    {0, -1, -phi},
                                                                    {0, 1, -phi},
                                                                    {phi, 0, -1},
                                                                    {phi, 0, 1},
                                                                    {-phi, 0, -1},
                                                                    {-phi, 0, 1}})
    mesh.directions.push_back(glm::normalize(corner));
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

DirectionMesh octahedron_directions() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// Turns edges of a closed surface, star-shaped about the origin and with all vertices on a convex body, until none is
/// reflex: then it is their convex hull. Each turn adds a tetrahedron, so it ends; flat to `least` is convex.
void make_convex(Mesh& mesh) {
  constexpr double least = 1e-12;  // of six times a tetrahedron's volume, against turning flat quadrilaterals for ever
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> opposite;  // directed edge to its triangle's third vertex
  std::vector<std::pair<uint32_t, uint32_t>> suspects;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      opposite[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
      suspects.emplace_back(t[k], t[(k + 1) % 3]);
    }
  const auto position = [&](uint32_t i) { return glm::dvec3(mesh.positions[i]); };
  while (!suspects.empty()) {
    const auto [a, b] = suspects.back();
    suspects.pop_back();
    const auto edge = opposite.find({a, b});
    if (edge == opposite.end()) continue;  // turned meanwhile
    const uint32_t c = edge->second, d = opposite.at({b, a});
    if (glm::dot(area_vector(position(a), position(b), position(c)), position(d) - position(a)) <= least) continue;
    opposite.erase({a, b});
    opposite.erase({b, a});
    for (const auto& [from, to, third] : {std::array{a, d, c}, {d, c, a}, {c, a, d}, {d, b, c}, {b, c, d}, {c, d, b}})
      opposite[{from, to}] = third;
    suspects.insert(suspects.end(), {{a, d}, {d, b}, {b, c}, {c, a}});
  }
  mesh.triangles.clear();
  for (const auto& [edge, c] : opposite)
    if (edge.first < edge.second && edge.first < c) mesh.triangles.emplace_back(edge.first, edge.second, c);
}

/// Unit vector at the angle of `step` of `steps` around +Y, from +X towards -Z: counter-clockwise seen from above.
/// Steps that are a full turn apart give the same bits.
glm::dvec3 around_axis(double step, int steps) {
  const double angle = 2.0 * std::numbers::pi * std::fmod(step, steps) / steps;
  return {std::cos(angle), 0.0, -std::sin(angle)};
}

/// A flat disc at height y whose front faces up or down.
void append_disc(Mesh& mesh, double radius, double y, int segments, bool up) {
  const glm::vec3 normal(0.0f, up ? 1.0f : -1.0f, 0.0f);
  const uint32_t center = add_vertex(mesh, glm::dvec3(0.0, y, 0.0), normal);
  for (int i = 0; i < segments; ++i)
    add_vertex(mesh, radius * around_axis(i, segments) + glm::dvec3(0.0, y, 0.0), normal);
  for (int i = 0; i < segments; ++i) {
    const uint32_t a = center + 1 + i, b = center + 1 + (i + 1) % segments;
    mesh.triangles.push_back(up ? glm::uvec3(center, a, b) : glm::uvec3(center, b, a));
  }
}

void require_segments(int segments) {
  if (segments < 3 || segments > 4096) throw Error("segments", "must be in [3, 4096]");
}

}  // namespace

Mesh quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  const glm::vec3 first = face_normal(a, b, c), second = face_normal(a, c, d);
  if (glm::dot(first, second) >
      1.0f - 1e-6f)  // corners are given to 1e-4 of their distance: anything flatter is rounding
    return {{a, b, c, d}, {first, first, first, first}, {{0, 1, 2}, {0, 2, 3}}};
  return {{a, b, c, a, c, d}, {first, first, first, second, second, second}, {{0, 1, 2}, {3, 4, 5}}};
}

Mesh box(const glm::vec3& min, const glm::vec3& max) {
  const auto corner = [&](int x, int y, int z) {
    return glm::vec3(x ? max.x : min.x, y ? max.y : min.y, z ? max.z : min.z);
  };
  Mesh mesh;
  append(mesh, quad(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0)));
  append(mesh, quad(corner(1, 0, 1), corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1)));
  append(mesh, quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)));
  append(mesh, quad(corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), corner(0, 1, 0)));
  append(mesh, quad(corner(1, 0, 0), corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0)));
  append(mesh, quad(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)));
  return mesh;
}

Mesh plane(float side) {
  const float h = 0.5f * side;
  return quad({-h, 0, h}, {h, 0, h}, {h, 0, -h}, {-h, 0, -h});
}

Mesh icosahedron() { return flat_shaded(icosphere(0)); }

Mesh icosphere(int subdivisions) {
  const DirectionMesh sphere = subdivided(icosahedron_directions(), subdivisions);
  Mesh mesh;
  for (const glm::dvec3& d : sphere.directions) add_vertex(mesh, d, d);
  mesh.triangles = sphere.triangles;
  return mesh;
}

Mesh rounded_box(const glm::vec3& half_extent, float power, int subdivisions) {
  if (!(power >= 2.0f && power <= 5.0f)) throw Error("power", "must be in [2, 5]");
  const DirectionMesh sphere = subdivided(octahedron_directions(), subdivisions);
  const double p = power;
  Mesh mesh;
  for (const glm::dvec3& d : sphere.directions) {
    const glm::dvec3 size = glm::abs(d);
    const glm::dvec3 unit = d / std::pow(std::pow(size.x, p) + std::pow(size.y, p) + std::pow(size.z, p), 1.0 / p);
    // The gradient of sum |x_a / h_a|^p is p |x_a / h_a|^(p-1) sign(x_a) / h_a; `unit` is x / h.
    const glm::dvec3 gradient =
        glm::pow(glm::abs(unit), glm::dvec3(p - 1.0)) * glm::sign(unit) / glm::dvec3(half_extent);
    add_vertex(mesh, unit * glm::dvec3(half_extent), glm::normalize(gradient));
  }
  mesh.triangles = sphere.triangles;
  make_convex(mesh);
  return mesh;
}

Mesh cone(float radius, float height, int segments) {
  require_segments(segments);
  const double r = radius, h = height;
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    // The side's normal is radial x height + up x radius. The apex has one normal per segment, that of the segment's
    // middle.
    const auto normal = [&](double step) {
      return glm::normalize(h * around_axis(step, segments) + glm::dvec3(0.0, r, 0.0));
    };
    const auto rim = [&](double step) { return r * around_axis(step, segments) - glm::dvec3(0.0, 0.5 * h, 0.0); };
    const uint32_t a = add_vertex(mesh, rim(i), normal(i));
    add_vertex(mesh, rim(i + 1), normal(i + 1));
    add_vertex(mesh, glm::dvec3(0.0, 0.5 * h, 0.0), normal(i + 0.5));
    mesh.triangles.emplace_back(a, a + 1, a + 2);
  }
  append_disc(mesh, r, -0.5 * h, segments, false);
  return mesh;
}

Mesh cylinder(float radius, float height, int segments) {
  require_segments(segments);
  const double r = radius, half = 0.5 * height;
  Mesh mesh;
  for (int i = 0; i < segments; ++i)
    for (const double y : {-half, half})
      add_vertex(mesh, r * around_axis(i, segments) + glm::dvec3(0.0, y, 0.0), around_axis(i, segments));
  for (int i = 0; i < segments; ++i) {
    const uint32_t a = 2 * i, b = 2 * ((i + 1) % segments);
    mesh.triangles.emplace_back(a, b, b + 1);
    mesh.triangles.emplace_back(a, b + 1, a + 1);
  }
  append_disc(mesh, r, half, segments, true);
  append_disc(mesh, r, -half, segments, false);
  return mesh;
}

Mesh torus(float ring_radius, float tube_radius, int segments, int sides) {
  require_segments(segments);
  require_segments(sides);
  Mesh mesh;
  for (int i = 0; i < segments; ++i)
    for (int j = 0; j < sides; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / sides;
      const glm::dvec3 radial = around_axis(i, segments);
      const glm::dvec3 normal = std::cos(angle) * radial + glm::dvec3(0.0, std::sin(angle), 0.0);
      add_vertex(mesh, double(ring_radius) * radial + double(tube_radius) * normal, normal);
    }
  const auto vertex = [&](int i, int j) { return static_cast<uint32_t>((i % segments) * sides + j % sides); };
  for (int i = 0; i < segments; ++i)
    for (int j = 0; j < sides; ++j) {
      mesh.triangles.emplace_back(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      mesh.triangles.emplace_back(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  return mesh;
}

}  // namespace voxref
