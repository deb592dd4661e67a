#include "voxel/grid.h"

#include <random>

#include "catch.h"
#include "error.h"

using namespace voxref;

namespace {

Bounds box(const glm::vec3& min, const glm::vec3& max) {
  Bounds bounds;
  bounds.add(min);
  bounds.add(max);
  return bounds;
}

}  // namespace

TEST_CASE("walls on the bounds of the longest axis lie at voxel centres, 1.5 voxels inside", "[grid]") {
  for (const int resolution : {16, 64, 100, 256, 2048}) {
    const Bounds bounds = box({-1.0f, 2.0f, 0.5f}, {3.0f, 3.0f, 2.5f});
    const Grid grid = fit_grid(bounds, {resolution});
    CHECK(grid.size.x == resolution);
    CHECK(grid.voxel == Approx(4.0 / (resolution - 3)).epsilon(1e-6));  // rounding to float32
    // Voxel coordinates up to 2048 times a rounding of 6e-8, for min, h and the division.
    const double rounding = 3.0 * resolution * 6e-8;
    CHECK(grid.to_voxels(bounds.min).x == Approx(1.5).margin(rounding));
    CHECK(grid.to_voxels(bounds.max).x == Approx(resolution - 1.5).margin(rounding));
  }
}

TEST_CASE("a grid fits its bounds: centred, at least 1.5 voxels of margin, no more than it needs", "[grid]") {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (int trial = 0; trial < 200; ++trial) {
    const glm::vec3 min(uniform(random), -uniform(random), 10.0f * uniform(random));
    const Bounds bounds = box(min, min + glm::vec3(uniform(random), uniform(random), uniform(random)));
    const Grid grid = fit_grid(bounds, {64});
    const glm::vec3 low = grid.to_voxels(bounds.min), high = glm::vec3(grid.size) - grid.to_voxels(bounds.max);
    int longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // 1e-3: extents up to 1e-4 voxels over a whole number count as whole, and float32 rounds coordinates up to 10.
      CHECK(low[axis] > 1.5f - 1e-3f);
      CHECK(low[axis] < 2.5f);
      CHECK(std::abs(low[axis] - high[axis]) < 1e-3f);
      CHECK(grid.size[axis] >= 4);
      longest = std::max(longest, grid.size[axis]);
    }
    CHECK(longest == 64);
  }
}

TEST_CASE("a cube gets a cube, whatever the rounding of its sides", "[grid]") {
  CHECK(fit_grid(box(glm::vec3(0.1f), glm::vec3(0.7f)), {128}).size == glm::ivec3(128));
  CHECK(fit_grid(box({0.1f, 1.1f, -0.3f}, {0.7f, 1.7f, 0.3f}), {128}).size == glm::ivec3(128));
}

TEST_CASE("a flat scene gets five voxels across, itself at their middle", "[grid]") {
  const Grid grid = fit_grid(box({0, 1, 0}, {4, 1, 2}), {67});
  CHECK(grid.size == glm::ivec3(67, 5, 35));
  CHECK(grid.to_voxels({0, 1, 0}).y == Approx(2.5));
  CHECK(fit_grid(box({0, 1, 0}, {0, 1, 2}), {67}).size == glm::ivec3(5, 5, 67));
}

TEST_CASE("nothing and a point get four unit voxels a side", "[grid]") {
  const Grid nothing = fit_grid({}, {256}), point = fit_grid(box({7, 8, 9}, {7, 8, 9}), {256});
  CHECK(nothing.size == glm::ivec3(4));
  CHECK(nothing.voxel == 1.0f);
  CHECK(nothing.min == glm::vec3(-2));
  CHECK(point.size == glm::ivec3(4));
  CHECK(point.min == glm::vec3(5, 6, 7));
}

TEST_CASE("a grid scales and moves with its scene to the bit, for dyadic data", "[grid]") {
  const Bounds bounds = box({0, 0, 0}, {2, 1, 0.5f});
  const Grid grid = fit_grid(bounds, {67});  // 64 voxels of 1/32 inside
  const Grid moved = fit_grid(box(bounds.min + 0.25f, bounds.max + 0.25f), {67});
  const Grid scaled = fit_grid(box(1024.0f * bounds.min, 1024.0f * bounds.max), {67});
  CHECK(grid.voxel == 1.0f / 32.0f);
  CHECK(moved.size == grid.size);
  CHECK(moved.min == grid.min + 0.25f);
  CHECK(scaled.size == grid.size);
  CHECK(scaled.min == 1024.0f * grid.min);
  CHECK(scaled.voxel == 1024.0f * grid.voxel);
}

TEST_CASE("a resolution out of range and voxels finer than float32 are refused", "[grid]") {
  const Bounds unit = box(glm::vec3(0), glm::vec3(1));
  CHECK_THROWS_AS(fit_grid(unit, {15}), Error);
  CHECK_THROWS_AS(fit_grid(unit, {2049}), Error);
  CHECK_NOTHROW(fit_grid(unit, {16}));
  CHECK_NOTHROW(fit_grid(unit, {2048}));
  CHECK_THROWS_AS(fit_grid(box(glm::vec3(1e6f), glm::vec3(1e6f + 1.0f)), {256}), Error);
  CHECK_THROWS_AS(fit_grid(box(glm::vec3(-3e38f), glm::vec3(3e38f)), {16}), Error);
  CHECK_NOTHROW(fit_grid(box(glm::vec3(0), glm::vec3(1e-20f)), {256}));
}
