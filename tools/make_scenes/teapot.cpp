#include "make_scenes/teapot.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "error.h"

namespace voxref {
namespace {

/// The published control points of one copy of each patch, +Z up; the rest of the 306 are their mirror images.
constexpr std::array<glm::dvec3, 127> control_points = {{
    {0.2, 0, 2.7},
    {0.2, -0.112, 2.7},
    {0.112, -0.2, 2.7},
    {0, -0.2, 2.7},
    {1.3375, 0, 2.53125},
    {1.3375, -0.749, 2.53125},
    {0.749, -1.3375, 2.53125},
    {0, -1.3375, 2.53125},
    {1.4375, 0, 2.53125},
    {1.4375, -0.805, 2.53125},
    {0.805, -1.4375, 2.53125},
    {0, -1.4375, 2.53125},
    {1.5, 0, 2.4},
    {1.5, -0.84, 2.4},
    {0.84, -1.5, 2.4},
    {0, -1.5, 2.4},
    {1.75, 0, 1.875},
    {1.75, -0.98, 1.875},
    {0.98, -1.75, 1.875},
    {0, -1.75, 1.875},
    {2, 0, 1.35},
    {2, -1.12, 1.35},
    {1.12, -2, 1.35},
    {0, -2, 1.35},
    {2, 0, 0.9},
    {2, -1.12, 0.9},
    {1.12, -2, 0.9},
    {0, -2, 0.9},
    {-2, 0, 0.9},
    {2, 0, 0.45},
    {2, -1.12, 0.45},
    {1.12, -2, 0.45},
    {0, -2, 0.45},
    {1.5, 0, 0.225},
    {1.5, -0.84, 0.225},
    {0.84, -1.5, 0.225},
    {0, -1.5, 0.225},
    {1.5, 0, 0.15},
    {1.5, -0.84, 0.15},
    {0.84, -1.5, 0.15},
    {0, -1.5, 0.15},
    {-1.6, 0, 2.025},
    {-1.6, -0.3, 2.025},
    {-1.5, -0.3, 2.25},
    {-1.5, 0, 2.25},
    {-2.3, 0, 2.025},
    {-2.3, -0.3, 2.025},
    {-2.5, -0.3, 2.25},
    {-2.5, 0, 2.25},
    {-2.7, 0, 2.025},
    {-2.7, -0.3, 2.025},
    {-3, -0.3, 2.25},
    {-3, 0, 2.25},
    {-2.7, 0, 1.8},
    {-2.7, -0.3, 1.8},
    {-3, -0.3, 1.8},
    {-3, 0, 1.8},
    {-2.7, 0, 1.575},
    {-2.7, -0.3, 1.575},
    {-3, -0.3, 1.35},
    {-3, 0, 1.35},
    {-2.5, 0, 1.125},
    {-2.5, -0.3, 1.125},
    {-2.65, -0.3, 0.9375},
    {-2.65, 0, 0.9375},
    {-2, -0.3, 0.9},
    {-1.9, -0.3, 0.6},
    {-1.9, 0, 0.6},
    {1.7, 0, 1.425},
    {1.7, -0.66, 1.425},
    {1.7, -0.66, 0.6},
    {1.7, 0, 0.6},
    {2.6, 0, 1.425},
    {2.6, -0.66, 1.425},
    {3.1, -0.66, 0.825},
    {3.1, 0, 0.825},
    {2.3, 0, 2.1},
    {2.3, -0.25, 2.1},
    {2.4, -0.25, 2.025},
    {2.4, 0, 2.025},
    {2.7, 0, 2.4},
    {2.7, -0.25, 2.4},
    {3.3, -0.25, 2.4},
    {3.3, 0, 2.4},
    {2.8, 0, 2.475},
    {2.8, -0.25, 2.475},
    {3.525, -0.25, 2.49375},
    {3.525, 0, 2.49375},
    {2.9, 0, 2.475},
    {2.9, -0.15, 2.475},
    {3.45, -0.15, 2.5125},
    {3.45, 0, 2.5125},
    {2.8, 0, 2.4},
    {2.8, -0.15, 2.4},
    {3.2, -0.15, 2.4},
    {3.2, 0, 2.4},
    {0, 0, 3.15},
    {0.8, 0, 3.15},
    {0.8, -0.45, 3.15},
    {0.45, -0.8, 3.15},
    {0, -0.8, 3.15},
    {0, 0, 2.85},
    {1.4, 0, 2.4},
    {1.4, -0.784, 2.4},
    {0.784, -1.4, 2.4},
    {0, -1.4, 2.4},
    {0.4, 0, 2.55},
    {0.4, -0.224, 2.55},
    {0.224, -0.4, 2.55},
    {0, -0.4, 2.55},
    {1.3, 0, 2.55},
    {1.3, -0.728, 2.55},
    {0.728, -1.3, 2.55},
    {0, -1.3, 2.55},
    {1.3, 0, 2.4},
    {1.3, -0.728, 2.4},
    {0.728, -1.3, 2.4},
    {0, -1.3, 2.4},
    {0, 0, 0},
    {1.425, -0.798, 0},
    {1.5, 0, 0.075},
    {1.425, 0, 0},
    {0.798, -1.425, 0},
    {0, -1.5, 0.075},
    {0, -1.425, 0},
    {1.5, -0.84, 0.075},
    {0.84, -1.5, 0.075},
}};

struct Patch {
  std::array<int, 16> points;  ///< row by row; d/du x d/dv points outwards, u along a row
  bool four_fold;              ///< mirrored in x and in y, not in y alone
};

constexpr std::array<Patch, 10> patches = {{
    {{102, 103, 104, 105, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, true},                // rim
    {{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27}, true},              // upper body
    {{24, 25, 26, 27, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40}, true},              // lower body
    {{96, 96, 96, 96, 97, 98, 99, 100, 101, 101, 101, 101, 0, 1, 2, 3}, true},             // the lid's knob
    {{0, 1, 2, 3, 106, 107, 108, 109, 110, 111, 112, 113, 114, 115, 116, 117}, true},      // lid
    {{118, 118, 118, 118, 124, 122, 119, 121, 123, 126, 125, 120, 40, 39, 38, 37}, true},  // bottom
    {{41, 42, 43, 44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56}, false},             // upper handle
    {{53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, 64, 28, 65, 66, 67}, false},             // lower handle
    {{68, 69, 70, 71, 72, 73, 74, 75, 76, 77, 78, 79, 80, 81, 82, 83}, false},             // lower spout
    {{80, 81, 82, 83, 84, 85, 86, 87, 88, 89, 90, 91, 92, 93, 94, 95}, false},             // spout's tip
}};

/// The cubic Bernstein polynomials, or their derivatives.
struct Bernstein {
  std::array<double, 4> value, derivative;
  explicit Bernstein(double t) {
    const double s = 1.0 - t;
    value = {s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t};
    derivative = {-3.0 * s * s, 3.0 * s * s - 6.0 * t * s, 6.0 * t * s - 3.0 * t * t, 3.0 * t * t};
  }
};

glm::dvec3 sum(const Patch& patch, const std::array<double, 4>& u, const std::array<double, 4>& v) {
  glm::dvec3 point(0.0);
  for (size_t row = 0; row < 4; ++row)
    for (size_t column = 0; column < 4; ++column)
      point += u[column] * v[row] * control_points[patch.points[4 * row + column]];
  return point;
}

/// Patches evaluate their common edges in different orders; to 1e-6 of a unit they agree, and then to the last bit.
glm::dvec3 rounded(const glm::dvec3& point) { return glm::round(point * 1e6) / 1e6 + 0.0; }

glm::dvec3 y_up(const glm::dvec3& z_up) { return {z_up.x, z_up.z, -z_up.y}; }

/// One patch, or its image under a mirror of signs `mirror`, which turns the triangles round when it is a reflection.
Mesh tessellated(const Patch& patch, const glm::dvec3& mirror, int divisions) {
  Mesh mesh;
  for (int row = 0; row <= divisions; ++row)
    for (int column = 0; column <= divisions; ++column) {
      const Bernstein u(double(column) / divisions), v(double(row) / divisions);
      const glm::dvec3 dv = sum(patch, u.value, v.derivative);
      glm::dvec3 du = sum(patch, u.derivative, v.value);
      // At a pole, v = 0, a whole row is one point and d/du vanishes there as v d2/du dv.
      if (glm::length(du) < 1e-9) du = sum(patch, u.derivative, v.derivative);
      mesh.positions.emplace_back(y_up(rounded(mirror * sum(patch, u.value, v.value))));
      mesh.normals.emplace_back(y_up(glm::normalize(mirror * glm::cross(du, dv))));
    }
  const bool reflected = mirror.x * mirror.y < 0.0;
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const glm::vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    if (p == q || q == r || r == p) return;  // at a pole
    mesh.triangles.push_back(reflected ? glm::uvec3(a, c, b) : glm::uvec3(a, b, c));
  };
  const uint32_t stride = divisions + 1;
  for (int row = 0; row < divisions; ++row)
    for (int column = 0; column < divisions; ++column) {
      const uint32_t a = row * stride + column, b = a + 1, c = b + stride, d = a + stride;
      add(a, b, c);
      add(a, c, d);
    }
  return mesh;
}

/// Poles leave vertices that no triangle needs any more.
Mesh without_unused_vertices(const Mesh& mesh) {
  constexpr uint32_t unused = ~0u;
  std::vector<uint32_t> renamed(mesh.positions.size(), unused);
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) renamed[t[k]] = 0;
  Mesh result;
  for (size_t i = 0; i < renamed.size(); ++i)
    if (renamed[i] != unused) renamed[i] = add_vertex(result, mesh.positions[i], mesh.normals[i]);
  for (const glm::uvec3& t : mesh.triangles) result.triangles.emplace_back(renamed[t.x], renamed[t.y], renamed[t.z]);
  return result;
}

}  // namespace

Mesh teapot(int divisions) {
  if (divisions < 2 || divisions > 64) throw Error("divisions", "must be in [2, 64]");
  Mesh mesh;
  for (const Patch& patch : patches)
    for (const double x : {1.0, -1.0})
      for (const double y : {1.0, -1.0})
        if (x > 0.0 || patch.four_fold) append(mesh, tessellated(patch, {x, y, 1.0}, divisions));
  return without_unused_vertices(mesh);
}

}  // namespace voxref
