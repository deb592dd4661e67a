#include "cone/occupancy.h"

#include <bit>
#include <glm/geometric.hpp>
#include <random>

#include "catch.h"
#include "cone/raw_lookup.h"
#include "cone/volumes.h"

using namespace voxref;

namespace {

/// Sides that are neither powers of two nor multiples of a block's; one voxel in `rarity` is occupied.
Pyramid random_pyramid(const glm::ivec3& size, int rarity) {
  std::mt19937 random(11);
  return mipmap(
      unit_grid(size),
      fill(size, [&](const glm::ivec3&) { return glm::vec4(random() % unsigned(rarity) == 0 ? 0.25f : 0.0f); }), {});
}

glm::vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

}  // namespace

TEST_CASE("A look-up finds something where, and only where, the occupancy of its level says so", "[occupancy]") {
  const glm::ivec3 size(37, 21, 18);
  const Pyramid pyramid = random_pyramid(size, 150);
  const Occupancy occupied(pyramid);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> anywhere(-6.0f, 43.0f);  // beyond the border too
  const SquaredRead read(glm::normalize(glm::vec3(1.0f, -2.0f, 3.0f)));
  int empty = 0, full = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 p(anywhere(random), anywhere(random), anywhere(random));
    for (int level = 0; level <= 3; ++level) {
      const RawSamples samples(to_int4(size) - 1, Int8{} + level, Float8{} + 1.0f, Float8{} + p.x, Float8{} + p.y,
                               Float8{} + p.z);
      const bool found = sample_raw<PlainKernel>(pyramid, samples, 0, {0.0f, level, 0.0f, 1.0f}, read)[3] != 0.0f;
      (found ? full : empty)++;
      // Where the border goes on for ever, a cell at the border is read at its edge alone.
      const bool inside =
          glm::all(glm::greaterThan(p, glm::vec3(8.0f))) && glm::all(glm::lessThan(p, glm::vec3(size) - 8.0f));
      REQUIRE((occupied(level, to_float4(p)) || !found));
      if (inside) REQUIRE(occupied(level, to_float4(p)) == found);
      // Where a level is empty, so are all finer ones.
      if (level > 0 && !occupied(level, to_float4(p))) REQUIRE_FALSE(occupied(level - 1, to_float4(p)));
    }
  }
  CHECK(empty > 1000);
  CHECK(full > 1000);
}

TEST_CASE("Eight positions at once are found as each on its own, in eight levels", "[occupancy]") {
  const Pyramid pyramid = random_pyramid({150, 37, 70}, 2000);
  const Occupancy occupied(pyramid);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> anywhere(-20.0f, 170.0f);  // beyond the border too
  std::uniform_int_distribution<int> any_level(0, int(pyramid.levels.size()));
  int found = 0;
  for (int round = 0; round < 5000; ++round) {
    Float8 x, y, z;
    Int8 level;
    for (int i = 0; i < 8; ++i) x[i] = anywhere(random), y[i] = anywhere(random), z[i] = anywhere(random);
    for (int i = 0; i < 8; ++i) level[i] = any_level(random);
    uint32_t expected = 0;
    for (int i = 0; i < 8; ++i) expected |= uint32_t(occupied(level[i], Float4{x[i], y[i], z[i], 0.0f})) << i;
    REQUIRE(occupied(level, x, y, z) == expected);
    found += std::popcount(expected);
  }
  CHECK(found > 5000);
  CHECK(found < 35000);
}

TEST_CASE("All along a gap nothing is found, in its level and below", "[occupancy]") {
  const Pyramid pyramid = random_pyramid({40, 40, 40}, 4000);
  const Occupancy occupied(pyramid);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> inside(0.0f, 40.0f);
  int gaps = 0, climbed = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 p(inside(random), inside(random), inside(random)), way = 0.5f * random_direction(random);
    if (occupied(0, to_float4(p))) continue;
    const Occupancy::Gap gap = occupied.gap(0, to_float4(p), to_float4(way), 1.0f / to_float4(way));
    CHECK(gap.length >= 0.0f);
    climbed += gap.level > 1;
    for (int k = 0; k < 10; ++k)
      for (int level = 0; level <= gap.level; ++level)
        REQUIRE_FALSE(occupied(level, to_float4(p + gap.length * float(k) / 10.0f * way)));
    ++gaps;
  }
  CHECK(gaps > 1000);
  CHECK(climbed > 500);
}

TEST_CASE("A level that holds more than its parents do is occupied all the same", "[occupancy]") {
  // Volumes from somebody else's disk need not fit together.
  Pyramid pyramid =
      mipmap(unit_grid({16, 16, 16}),
             fill(glm::ivec3(16), [](const glm::ivec3& v) { return glm::vec4(v == glm::ivec3(1) ? 1.0f : 0.0f); }), {});
  pyramid.levels[0]({6, 6, 6})[0] = glm::vec4(0.5f);
  const Occupancy occupied(pyramid);
  CHECK(occupied(1, Float4{13.0f, 13.0f, 13.0f}));
  CHECK_FALSE(occupied(0, Float4{13.0f, 13.0f, 13.0f}));
  CHECK(occupied(2, Float4{13.0f, 13.0f, 13.0f}));
}
