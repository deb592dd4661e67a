#include "voxel/raster.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <tuple>
#include <vector>

#include "catch.h"
#include "voxel/mesh_scene.h"

using namespace voxref;

namespace {

const Grid grid = unit_grid(glm::ivec3(16));

RasterTriangle triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 n = glm::cross(b - a, c - a);
  return {{a, b, c}, {n, n, n}, {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}};
}

std::vector<RasterFragment> fragments(const RasterTriangle& t, const Grid& in = grid) {
  std::vector<RasterFragment> result;
  const auto dilated = DilatedTriangle::make(t, RasterViews(in));
  if (dilated)
    dilated->for_each_fragment(dilated->rows()[0], dilated->rows()[1],
                               [&](const RasterFragment& f) { result.push_back(f); });
  return result;
}

std::set<std::tuple<int, int, int>> voxels(const RasterTriangle& t, const Grid& in = grid) {
  std::set<std::tuple<int, int, int>> result;
  for (const RasterFragment& f : fragments(t, in)) result.insert({f.voxel.x, f.voxel.y, f.voxel.z});
  return result;
}

/// A triangle whose normal is along n.
std::array<glm::vec3, 3> facing(const glm::vec3& n) {
  const glm::vec3 u = glm::cross(n, std::abs(n.x) > std::abs(n.z) ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0));
  return {glm::vec3(8), glm::vec3(8) + u, glm::vec3(8) + glm::cross(n, u)};
}

}  // namespace

TEST_CASE("A triangle is drawn along the strictly greatest axis of its normal, along z at a tie", "[raster]") {
  CHECK(dominant_axis(facing({3, 2, 1})) == 0);
  CHECK(dominant_axis(facing({-3, 2, 1})) == 0);
  CHECK(dominant_axis(facing({1, -3, 2})) == 1);
  CHECK(dominant_axis(facing({1, 2, 3})) == 2);
  CHECK(dominant_axis(facing({2, 2, 1})) == 2);  // though z is the least of the three
  CHECK(dominant_axis(facing({2, 1, 2})) == 2);
  CHECK(dominant_axis(facing({1, 2, 2})) == 2);
  CHECK(dominant_axis(facing({1, 1, 1})) == 2);
}

TEST_CASE("A face at 45 degrees to x and y, upright to z, is drawn edge-on and vanishes", "[raster]") {
  CHECK(fragments(triangle({4, 8, 4}, {8, 4, 4}, {4, 8, 8})).empty());
  CHECK_FALSE(fragments(triangle({4, 8, 4}, {8, 4.25f, 4}, {4, 8, 8})).empty());  // just off 45 degrees
}

TEST_CASE("A triangle without area vanishes", "[raster]") {
  CHECK(fragments(triangle({4, 4, 4}, {8, 8, 8}, {6, 6, 6})).empty());
  CHECK(fragments(triangle({4, 4, 4}, {4, 4, 4}, {4, 4, 4})).empty());
}

TEST_CASE("The views look at the centre of the scene's box, which is not always the cube's", "[raster]") {
  // A sliver at z = 3.4 to 3.6, drawn along x, which half a pixel on each side makes 2.9 to 4.1. In a box of 15 voxels
  // along z pixels are centred on 3 and 4, where it has two; in a cube on 3.5 alone.
  const RasterTriangle sliver = triangle({8.5f, 2.0f, 3.4f}, {8.5f, 14.0f, 3.4f}, {8.5f, 8.0f, 3.6f});
  const auto slices = [&](float depth) {
    Bounds box;
    box.add(glm::vec3(0.0f));
    box.add({16.0f, 16.0f, depth});
    std::set<int> result;
    for (const auto& [x, y, z] : voxels(sliver, fit_grid(box, {16, true}))) result.insert(z);
    return result;
  };
  CHECK(slices(16.0f) == std::set<int>{3});
  CHECK(slices(15.0f) == std::set<int>{3, 4});
}

TEST_CASE("Along each axis a wall lands in the voxels that hold it", "[raster]") {
  // Lower left half of a square, in a plane of constant coordinate 5.5, the corners well inside voxels (2, 2) to (9,
  // 9).
  for (int axis = 0; axis < 3; ++axis) {
    const auto point = [axis](float u, float v) {
      glm::vec3 p;
      p[axis] = 5.5f, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
      return p;
    };
    CAPTURE(axis);
    std::set<std::tuple<int, int, int>> expected;
    for (int u = 2; u <= 9; ++u)
      for (int v = 2; v <= 9; ++v) {
        // A pixel belongs to the dilated triangle when the triangle meets its square: u + v <= 12 at the near corner.
        if (u + v >= 12) continue;
        glm::ivec3 voxel;
        voxel[axis] = 5, voxel[(axis + 1) % 3] = u, voxel[(axis + 2) % 3] = v;
        expected.insert({voxel.x, voxel.y, voxel.z});
      }
    for (const bool back : {false, true}) {
      const auto wall = back ? triangle(point(2.25f, 2.25f), point(2.25f, 9.4f), point(9.4f, 2.25f))
                             : triangle(point(2.25f, 2.25f), point(9.4f, 2.25f), point(2.25f, 9.4f));
      CHECK(voxels(wall) == expected);
    }
  }
}

TEST_CASE("Any overlap in the plane of projection counts, so that a tiny triangle is not lost", "[raster]") {
  // It misses the centre of its pixel (6.5, 6.5).
  CHECK(voxels(triangle({6.1f, 6.1f, 3.5f}, {6.2f, 6.1f, 3.5f}, {6.1f, 6.2f, 3.5f})) ==
        std::set<std::tuple<int, int, int>>{{6, 6, 3}});
}

TEST_CASE("In depth a triangle gets one voxel per pixel", "[raster]") {
  // Falls by 0.9 of its width along z: 26-separating coverage would have both voxels where it crosses a slice.
  const auto seen = fragments(triangle({2.1f, 2.1f, 2.0f}, {12.9f, 2.1f, 11.7f}, {2.1f, 12.9f, 2.0f}));
  std::set<std::tuple<int, int>> columns;
  for (const RasterFragment& f : seen) CHECK(columns.insert({f.voxel.x, f.voxel.y}).second);
}

TEST_CASE("A sharp corner's spike, where the dilated edges meet far out, is cut off at the box", "[raster]") {
  // The edges of a needle meet half a pixel / sin(half the angle) beyond its tip: 20 pixels here.
  for (const RasterFragment& f : fragments(triangle({3.5f, 8.5f, 4.5f}, {8.5f, 8.4f, 4.5f}, {8.5f, 8.6f, 4.5f}))) {
    CHECK(f.voxel.x >= 3);
    CHECK(f.voxel.x <= 8);
  }
}

TEST_CASE("Texture coordinates turn with the vertices that are swapped, normals do not", "[raster]") {
  const glm::vec3 a(2.5f, 2.5f, 5.5f), b(13.5f, 2.5f, 5.5f), c(2.5f, 13.5f, 5.5f);
  RasterTriangle front = triangle(a, b, c);
  front.normals = {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
  RasterTriangle back = front;  // the same triangle wound the other way: seen from behind along +z
  std::swap(back.positions[1], back.positions[2]);
  std::swap(back.normals[1], back.normals[2]);
  std::swap(back.uv[1], back.uv[2]);
  const auto front_seen = fragments(front), back_seen = fragments(back);
  REQUIRE(front_seen.size() == back_seen.size());
  // Attributes of the original corners stay attached to the dilated ones, which lie half a pixel further out.
  for (size_t i = 0; i < front_seen.size(); ++i) {
    const RasterFragment &f = front_seen[i], &r = back_seen[i];
    REQUIRE(f.voxel == r.voxel);
    CHECK(f.uv.x == Approx(r.uv.x).margin(1e-5));
    CHECK(f.uv.y == Approx(r.uv.y).margin(1e-5));
    // One of the two is swapped, and has its second and third normals exchanged.
    CHECK(f.normal.y == Approx(r.normal.z).margin(1e-5));
    CHECK(f.normal.z == Approx(r.normal.y).margin(1e-5));
    CHECK(f.normal.x + f.normal.y + f.normal.z == Approx(1.0).margin(1e-5));
  }
}

TEST_CASE("What lies outside the cube in depth is cut off", "[raster]") {
  // A wall that leans out of the cube's z range.
  for (const RasterFragment& f : fragments(triangle({2, 2, -4}, {14, 2, 6}, {2, 14, -4}))) {
    CHECK(f.voxel.z >= 0);
    CHECK(f.voxel.z < 16);
  }
  CHECK(fragments(triangle({2, 2, 17.5f}, {14, 2, 17.5f}, {2, 14, 17.5f})).empty());
}

TEST_CASE("Cutting a triangle's rows changes none of its fragments", "[raster]") {
  const auto t = triangle({1.3f, 2.2f, 3.1f}, {13.7f, 4.1f, 7.9f}, {5.2f, 14.6f, 5.5f});
  const auto dilated = DilatedTriangle::make(t, RasterViews(grid));
  REQUIRE(dilated);
  std::vector<glm::ivec3> whole, parts;
  const auto [first, last] = dilated->rows();
  dilated->for_each_fragment(first, last, [&](const RasterFragment& f) { whole.push_back(f.voxel); });
  for (int row = first; row < last; ++row)
    dilated->for_each_fragment(row, row + 1, [&](const RasterFragment& f) { parts.push_back(f.voxel); });
  CHECK(whole == parts);
}
