#include "voxel/clip.h"

#include <glm/geometric.hpp>
#include <random>

#include "catch.h"

using namespace voxref;

namespace {

ClipPolygon triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  ClipPolygon polygon;
  polygon.add({a, {0.0, 0.0}});
  polygon.add({b, {1.0, 0.0}});
  polygon.add({c, {0.0, 1.0}});
  return polygon;
}

double area(const ClipPolygon& polygon) { return 0.5 * glm::length(twice_vector_area(polygon)); }

}  // namespace

TEST_CASE("the pieces of a triangle sum to it, lie in their cells and carry its coordinates", "[clip]") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(0.0, 12.0);
  for (int trial = 0; trial < 200; ++trial) {
    const auto point = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
    const glm::dvec3 a = point(), b = point(), c = point();
    const ClipPolygon whole = triangle(a, b, c);
    double sum = 0.0;
    for_each_cell(whole, 1, glm::ivec3(0), glm::ivec3(12),
                  [&](const glm::ivec3& cell, const ClipPolygon& piece, double share) {
                    REQUIRE(share == 1.0);
                    sum += area(piece);
                    for (int i = 0; i < piece.size(); ++i) {
                      const auto& [p, uv] = piece[i];
                      // Rounding of an interpolation between numbers up to 12; the plane's own coordinate is set
                      // exactly.
                      for (int axis = 0; axis < 3; ++axis) {
                        REQUIRE(p[axis] >= cell[axis] - 1e-14);
                        REQUIRE(p[axis] <= cell[axis] + 1 + 1e-14);
                      }
                      REQUIRE(glm::length(p - ((1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c)) < 1e-12);
                    }
                  });
    REQUIRE(sum == Approx(area(whole)).epsilon(1e-12));  // thirty pieces of double precision
  }
}

TEST_CASE("cells of eight hold the same as their cells of one", "[clip]") {
  const ClipPolygon whole = triangle({1, 2, 3}, {15, 9, 4}, {6, 15, 14});
  double direct = 0.0, nested = 0.0;
  for_each_cell(whole, 1, glm::ivec3(0), glm::ivec3(16), [&](const glm::ivec3& cell, const ClipPolygon& piece, double) {
    direct += area(piece) * (1 + cell.x);
  });
  for_each_cell(whole, 8, glm::ivec3(0), glm::ivec3(2), [&](const glm::ivec3& brick, const ClipPolygon&, double) {
    const glm::ivec3 first = brick * 8;
    const ClipPolygon inside = clip_to_box(whole, glm::dvec3(first), glm::dvec3(first + 8));
    for_each_cell(inside, 1, first, first + 8, [&](const glm::ivec3& cell, const ClipPolygon& piece, double) {
      nested += area(piece) * (1 + cell.x);
    });
  });
  CHECK(nested == Approx(direct).epsilon(1e-12));
}

TEST_CASE("a cut leaves nothing of what only touches the plane", "[clip]") {
  ClipPolygon below, above;
  split(triangle({0, 0, 0}, {1, 0, 0}, {1, 1, 0}), 0, 1.0, below, above);  // an edge in the plane
  CHECK(area(below) == 0.5);
  CHECK(above.empty());
  split(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0, 1.0, below, above);  // a corner
  CHECK(area(below) == 0.5);
  CHECK(above.empty());
  split(triangle({1, 0, 0}, {1, 1, 0}, {1, 0, 1}), 0, 1.0, below, above);  // all of it: on both sides
  CHECK(area(below) == 0.5);
  CHECK(area(above) == 0.5);
}

TEST_CASE("a polygon in a face is shared by two cells, in the grid's boundary kept for the one inside", "[clip]") {
  const auto shares = [](double x) {
    std::vector<std::pair<int, double>> result;
    for_each_slab(triangle({x, 0, 0}, {x, 1, 0}, {x, 0, 1}), 0, 1, 0, 4,
                  [&](int cell, const ClipPolygon&, double share) { result.emplace_back(cell, share); });
    return result;
  };
  CHECK(shares(2.0) == std::vector<std::pair<int, double>>{{1, 0.5}, {2, 0.5}});
  CHECK(shares(2.5) == std::vector<std::pair<int, double>>{{2, 1.0}});
  CHECK(shares(0.0) == std::vector<std::pair<int, double>>{{0, 0.5}});
  CHECK(shares(4.0) == std::vector<std::pair<int, double>>{{3, 0.5}});
}
