#include "cone/optical_depth.h"

#include <cmath>
#include <random>

#include "catch.h"
#include "cone/optical_texel.h"
#include "cone/volumes.h"

using namespace voxref;

namespace {

std::vector<BrickVolume<glm::vec3>> depths(const glm::ivec3& size,
                                           const std::function<float(const glm::ivec3&)>& opacity) {
  return optical_depths(mipmap(
      unit_grid(size), fill(size, [&](const glm::ivec3& v) { return glm::vec4(0.0f, 0.0f, 0.0f, opacity(v)); }), {}));
}

const float opaque = -std::log(1e-4f);

glm::vec3 at(const BrickVolume<glm::vec3>& level, const glm::ivec3& v) { return level(v); }

}  // namespace

TEST_CASE("Two texels that cover what the other leaves open are opaque together", "[optical_depth]") {
  // A diagonal wall, one voxel thick, x = y + 1: along x, texel (0,0) covers the lower rows and (1,0) none; the rows of
  // texel (i,i) are covered half by it and half by its neighbour (i+1,i).
  const auto level = depths({16, 16, 16}, [](const glm::ivec3& v) { return v.x == v.y + 1 ? 1.0f : 0.0f; })[0];
  const glm::vec3 first = at(level, {3, 3, 3}), second = at(level, {4, 3, 3});
  CHECK(first.x == Approx(opaque / 2.0f).epsilon(1e-3));  // 1 - 1e-4 in float is good to 6e-4 of 1e-4
  CHECK(second.x == Approx(opaque / 2.0f).epsilon(1e-3));
  // Edge on, along z, the same columns are covered in every texel: nothing is added to 2 of 4 and 1 of 4.
  // An opaque column counts as 1 - 1e-4.
  CHECK(first.z == Approx(-std::log(0.75)).epsilon(2e-4));
  CHECK(second.z == Approx(-std::log(0.75)).epsilon(2e-4));
}

TEST_CASE("An oblique wall is opaque along the axis that it faces most, at every level", "[optical_depth]") {
  const glm::ivec3 size(64, 64, 64);
  bool leaks = false;
  for (const glm::vec3 normal : {glm::vec3(1, 1, 0), glm::vec3(3, 4, 0), glm::vec3(2, 6, 3), glm::vec3(4, 5, 4)}) {
    const auto plane = [&](const glm::ivec3& v) { return glm::dot(glm::vec3(v) - 31.3f, normal); };
    const float half = 0.5f * (normal.x + normal.y + normal.z);  // 26-separating
    const Pyramid pyramid = mipmap(
        unit_grid(size),
        fill(size, [&](const glm::ivec3& v) { return glm::vec4(0, 0, 0, std::abs(plane(v)) <= half ? 1 : 0); }), {});
    const auto levels = optical_depths(pyramid);
    for (size_t k = 0; k < 4; ++k) {
      const int side = 32 >> k;
      float together = 0.0f, independent = 0.0f;  // through the row of texels along y in the middle
      for (int y = 0; y < side; ++y) {
        const glm::ivec3 v(side / 2, y, side / 2);
        together += at(levels[k], v).y;
        independent += optical_depth(pyramid.levels[k](v)[size_t(Face::pos_y)].a);
      }
      CAPTURE(normal.x, normal.y, normal.z, k);
      // A wall that lies across three texels is joined in pairs but not as a whole: 2.2e-4 at most here.
      CHECK(std::exp(-together) < 4e-4f);
      CHECK(together >= independent * (1.0f - 1e-4f));  // but for the rounding of 1 - 1e-4
      leaks = leaks || std::exp(-independent) > 0.1f;
    }
  }
  CHECK(leaks);  // by the filter alone
}

TEST_CASE("Depths are what the formula gives on dense arrays", "[optical_depth]") {
  const glm::ivec3 size(12, 10, 9);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<float> opacity(size_t(size.x * size.y * size.z));
  for (float& a : opacity) a = uniform(random) < 0.6f ? 0.0f : std::min(1.0f, 1.5f * uniform(random));
  const auto base = [&](const glm::ivec3& v) { return opacity[size_t(v.x + size.x * (v.y + size.y * v.z))]; };
  const auto levels = depths(size, base);

  const auto depth = [](double a) { return -std::log1p(-std::min(a, 1.0 - 1e-4)); };
  std::function<double(int, glm::ivec3, int)> expected = [&](int level, glm::ivec3 v, int axis) -> double {
    const glm::ivec3 n = (size + (1 << level) - 1) / (1 << level);
    if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, n))) return 0.0;
    if (level == 0) return depth(base(v));
    const auto column = [&](glm::ivec3 texel, int i) {
      glm::ivec3 child = 2 * texel;
      child[(axis + 1) % 3] += i & 1;
      child[(axis + 2) % 3] += i >> 1;
      glm::ivec3 next = child;
      ++next[axis];
      return expected(level - 1, child, axis) + expected(level - 1, next, axis);
    };
    const auto mean = [&](const glm::ivec3* a, const glm::ivec3* b) {
      double sum = 0.0;
      for (int i = 0; i < 4; ++i) {
        const double t = column(*a, i) + (b ? column(*b, i) : 0.0);
        sum += 0.25 * std::min(1.0 - std::exp(-t), 1.0 - 1e-4);
      }
      return depth(sum);
    };
    double result = mean(&v, nullptr);
    if (result == 0.0) return 0.0;
    for (const int side : {-1, 1}) {
      glm::ivec3 other = v;
      other[axis] += side;
      result += 0.5 * std::max(0.0, mean(&v, &other) - mean(&v, nullptr) - mean(&other, nullptr));
    }
    return std::min(result, -std::log(1e-4));
  };
  for (int level = 1; level <= 3; ++level) {
    const glm::ivec3 n = levels[size_t(level - 1)].size();
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x)
          for (int axis = 0; axis < 3; ++axis) {
            CAPTURE(level, x, y, z, axis);
            // Near opacity a depth is the logarithm of a small difference: 1e-7 / 1e-4 of it.
            CHECK(at(levels[size_t(level - 1)], {x, y, z})[axis] ==
                  Approx(expected(level, {x, y, z}, axis)).epsilon(2e-3).margin(1e-5));
          }
  }
}

TEST_CASE("An opacity that is not a number makes depths that are none either", "[optical_depth]") {
  const auto level =
      depths({4, 4, 4}, [](const glm::ivec3& v) { return v == glm::ivec3(1) ? std::nanf("") : 0.5f; })[0];
  CHECK(std::isnan(at(level, {0, 0, 0}).x));
  CHECK_FALSE(std::isnan(at(level, {1, 1, 1}).x));
}
