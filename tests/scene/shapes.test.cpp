// The meshes that the project's own scenes are made of.
#include "make_scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "catch.h"
#include "error.h"
#include "make_scenes/teapot.h"
#include "scene/gltf.h"
#include "scene/topology.h"

using namespace std::numbers;
using voxref::Mesh;

namespace {

EdgeCounts edges(const Mesh& mesh) { return count_edges(mesh.positions, mesh.triangles); }
double volume(const Mesh& mesh) { return signed_volume(mesh.positions, mesh.triangles); }

/// The regular polygon of n corners inscribed in the circle of radius r.
double polygon_area(double r, int n) { return 0.5 * n * r * r * std::sin(2.0 * pi / n); }

struct Solid {
  std::string name;
  Mesh mesh;
  size_t triangles;
  double volume;  ///< exact, of the faceted shape
};

std::vector<Solid> solids() {
  // A regular icosahedron of circumradius 1: edge a = 1 / sin(2 pi / 5), volume 5 (3 + sqrt 5) / 12 a^3.
  const double edge = 1.0 / std::sin(0.4 * pi);
  const double icosahedron = 5.0 * (3.0 + std::sqrt(5.0)) / 12.0 * edge * edge * edge;
  // Pappus, on the inscribed polygons: a segment of the torus is a prismatoid around the tube's polygon.
  const double torus = 32.0 * std::sin(2.0 * pi / 32.0) * 0.35 * polygon_area(0.15, 16);
  return {
      {"box", voxref::box({-1, 0, 2}, {2, 4, 3}), 12, 12.0},
      {"icosahedron", voxref::icosahedron(), 20, icosahedron},
      {"cone", voxref::cone(0.5f, 2.0f, 32), 64, polygon_area(0.5, 32) * 2.0 / 3.0},
      {"cylinder", voxref::cylinder(0.5f, 2.0f, 32), 128, polygon_area(0.5, 32) * 2.0},
      {"torus", voxref::torus(0.35f, 0.15f, 32, 16), 1024, torus},
  };
}

}  // namespace

TEST_CASE("Solids are closed, face outwards and have the volume of their formula", "[scenes]") {
  for (const Solid& solid : solids()) {
    INFO(solid.name);
    CHECK(solid.mesh.triangles.size() == solid.triangles);
    CHECK(edges(solid.mesh).closed());
    CHECK(edges(solid.mesh).shared == solid.triangles * 3 / 2);
    // Vertices are rounded to float: 6e-8 of their size each, three factors, so a few 1e-7.
    CHECK(volume(solid.mesh) == Approx(solid.volume).epsilon(1e-6));
    CHECK(volume(voxref::flipped(solid.mesh)) == Approx(-solid.volume).epsilon(1e-6));
  }
}

TEST_CASE("Spheres and rounded boxes stay closed at every subdivision and approach the smooth body", "[scenes]") {
  double last = 1.0;
  for (int n = 0; n <= 4; ++n) {
    const Mesh sphere = voxref::icosphere(n);
    CHECK(sphere.triangles.size() == 20u << (2 * n));
    CHECK(edges(sphere).closed());
    const double error = 1.0 - volume(sphere) / (4.0 / 3.0 * pi);
    CHECK(error > 0.0);
    // Halving the edges quarters the error; from the icosahedron itself, far from the limit, at least a factor 2.5.
    if (n > 0) CHECK(last / error > (n == 1 ? 2.5 : 3.7));
    last = error;
  }
  const Mesh room = voxref::rounded_box({1.0f, 0.75f, 1.0f}, 4.0f, 5);
  CHECK(room.triangles.size() == 8192);  // the thesis's Light Box, table 4.1
  CHECK(room.positions.size() == 4098);
  CHECK(edges(room).closed());
  // |x|^4 + |y|^4 + |z|^4 <= 1 holds 8 Gamma(5/4)^3 / Gamma(7/4); facets take off less than 1 %.
  const double superellipsoid = 8.0 * std::pow(std::tgamma(1.25), 3.0) / std::tgamma(1.75) * 0.75;
  CHECK(volume(room) < superellipsoid);
  CHECK(volume(room) > 0.99 * superellipsoid);
  // Power 2 is the sphere: distance 1, normals radial. Both are computed in double and rounded to float.
  const Mesh ball = voxref::rounded_box(glm::vec3(1.0f), 2.0f, 3);
  for (size_t i = 0; i < ball.positions.size(); ++i) {
    CHECK(glm::length(ball.positions[i]) == Approx(1.0).epsilon(1e-6));
    CHECK(glm::dot(ball.positions[i], ball.normals[i]) == Approx(1.0).epsilon(1e-6));
  }
}

TEST_CASE("A twisted quadrilateral gets a normal per triangle, a flat one shares its corners", "[scenes]") {
  CHECK(voxref::quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}).positions.size() == 4);
  const Mesh twisted = voxref::quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0.1f}, {0, 1, 0});
  REQUIRE(twisted.positions.size() == 6);
  CHECK(twisted.normals[0] != twisted.normals[3]);
  CHECK(edges(twisted).open == 4);
  CHECK(edges(twisted).shared == 1);
}

TEST_CASE("Rotation turns counter-clockwise about its axis", "[scenes]") {
  const Mesh turned = voxref::rotated(voxref::plane(2.0f), 90.0f, {1.0f, 0.0f, 0.0f});
  CHECK(turned.normals[0].z == Approx(1.0f));  // +Y goes to +Z about +X
  CHECK(voxref::area(turned) == Approx(4.0));
}

TEST_CASE("Counts out of range are refused", "[scenes]") {
  CHECK_THROWS_AS(voxref::icosphere(-1), voxref::Error);
  CHECK_THROWS_AS(voxref::icosphere(9), voxref::Error);
  CHECK_THROWS_AS(voxref::rounded_box(glm::vec3(1.0f), 8.0f, 2), voxref::Error);
  CHECK_THROWS_AS(voxref::cone(1.0f, 1.0f, 2), voxref::Error);
  CHECK_THROWS_AS(voxref::torus(1.0f, 0.5f, 8, 2), voxref::Error);
  CHECK_THROWS_AS(voxref::teapot(1), voxref::Error);
}

TEST_CASE("The teapot's patches meet without gaps, with common normals", "[scenes]") {
  for (const int n : {2, 5, 8}) {
    const Mesh mesh = voxref::teapot(n);
    INFO(n);
    CHECK(mesh.triangles.size() == static_cast<size_t>(64 * n * n - 8 * n));
    const EdgeCounts counts = edges(mesh);
    CHECK(counts.tangled == 0);
    // Open are the two ends of handle and spout, 2 n edges each, and the rims of body and lid, 4 n each.
    CHECK(counts.open == static_cast<size_t>(16 * n));
  }
  const Mesh mesh = voxref::teapot(8);
  std::map<std::array<float, 3>, glm::vec3> normal_at;
  float least = 1.0f;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = mesh.positions[i] + 0.0f;
    const auto [seen, added] = normal_at.try_emplace({p.x, p.y, p.z}, mesh.normals[i]);
    if (p == glm::vec3(-2.0f, 0.9f, 0.0f)) continue;  // where the handle's end touches the body, two surfaces meet
    if (!added) least = std::min(least, glm::dot(seen->second, mesh.normals[i]));
  }
  CHECK(least > 1.0f - 1e-6f);  // the patches join smoothly; float rounding of unit vectors
}

TEST_CASE("The teapot is the one that everybody has", "[scenes]") {
  const auto file = shared_file("assets/objects/utah_teapot.glb");
  if (!file) VOXREF_SKIP("assets/objects/utah_teapot.glb is not there");
  const voxref::Scene shared = voxref::load_gltf(*file);
  const Mesh mesh = voxref::teapot(10);
  CHECK(mesh.triangles.size() == shared.triangles.size());
  voxref::Bounds bounds;
  for (const glm::vec3& p : mesh.positions) bounds.add(p);
  const voxref::Bounds expected = shared.bounds();
  for (int k = 0; k < 3; ++k) {
    CHECK(bounds.min[k] == Approx(expected.min[k]).margin(1e-5));  // both tessellate at the same parameters
    CHECK(bounds.max[k] == Approx(expected.max[k]).margin(1e-5));
  }
  double expected_area = 0.0;
  for (const glm::uvec3& t : shared.triangles) {
    const glm::dvec3 a = shared.positions[t.x], b = shared.positions[t.y], c = shared.positions[t.z];
    expected_area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  CHECK(voxref::area(mesh) == Approx(expected_area).epsilon(1e-4));  // diagonals may run the other way
}
