#include "voxel/shadow_volume.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "catch.h"

using namespace voxref;

namespace {

SurfaceGrid occupied(const glm::ivec3& size, const std::function<bool(const glm::ivec3&)>& in) {
  SurfaceGrid surfaces;
  surfaces.grid.size = size;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (in({x, y, z})) {
          surfaces.voxels.emplace_back(x, y, z);
          surfaces.albedo.emplace_back(0.5f, 0.5f, 0.5f, 1.0f);
        }
  return surfaces;
}

/// The shader, line by line, on a dense array: what the fast march must equal to the bit.
class PlainShadow {
 public:
  explicit PlainShadow(const SurfaceGrid& surfaces)
      : size_(surfaces.grid.size.x), alpha_(size_t(size_ * size_ * size_)) {
    for (const glm::ivec3& v : surfaces.voxels) at(v) = 1.0f / 255.0f;  // one fragment
  }
  float visibility(const glm::vec3& from, const glm::vec3& direction, float distance, float hit) {
    const float step = 1.0f / float(size_), k = hit * hit;
    float t = 2.0f * step, v = 0.0f;
    while (v <= 1.0f && t <= distance) {
      const glm::vec3 p = direction * t + from;
      if (p.x < 0 || p.y < 0 || p.z < 0 || p.x > 1 || p.y > 1 || p.z > 1) break;
      const float s = std::ceil(texture(p)) * k;
      if (s > 1.0f) return 0.0f;
      v += (1.0f - v) * s / t;
      t += step;
    }
    return 1.0f - v;
  }

 private:
  float& at(const glm::ivec3& v) { return alpha_[size_t(v.x + size_ * (v.y + size_ * v.z))]; }
  float texture(const glm::vec3& p) {
    glm::vec3 low;
    glm::vec3 f;
    for (int a = 0; a < 3; ++a) {
      const float x = p[a] * float(size_) - 0.5f;
      low[a] = std::floor(x);
      f[a] = x - low[a];
    }
    float sum = 0.0f;
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 offset(i & 1, i >> 1 & 1, i >> 2);
      float weight = 1.0f;
      for (int a = 0; a < 3; ++a) weight *= offset[a] ? f[a] : 1.0f - f[a];
      glm::ivec3 v = glm::ivec3(low) + offset;
      for (int a = 0; a < 3; ++a) v[a] = std::clamp(v[a], 0, size_ - 1);  // clamp to edge
      sum += weight * at(v);
    }
    return sum;
  }
  int size_;
  std::vector<float> alpha_;
};

const glm::ivec3 size(32);
const glm::vec3 up(0, 1, 0);
/// The centre of voxel (16, 4, 16), from which a march along +y meets texel centres exactly.
const glm::vec3 start(16.5f / 32, 4.5f / 32, 16.5f / 32);

SurfaceGrid layer(int y) {
  return occupied(size, [y](const glm::ivec3& v) { return v.y == y; });
}

}  // namespace

TEST_CASE("The fast shadow march has the bits of the plain one", "[shadow_volume]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const float density : {0.0f, 0.0005f, 0.01f, 0.3f}) {
    const SurfaceGrid surfaces = occupied(size, [&](const glm::ivec3&) { return unit(random) < density; });
    const ShadowVolume fast(surfaces);
    PlainShadow plain(surfaces);
    size_t different = 0;
    for (int i = 0; i < 3000; ++i) {
      const glm::vec3 from(unit(random), unit(random), unit(random));
      glm::vec3 direction = glm::vec3(unit(random), unit(random), unit(random)) - 0.5f;
      if (i % 7 == 0) direction = glm::vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);  // along an axis
      direction = glm::normalize(direction);
      const float hit = i % 2 ? 0.5f : 0.2f, distance = unit(random);
      different += fast.visibility(from, direction, distance, hit) != plain.visibility(from, direction, distance, hit);
    }
    CAPTURE(density);
    CHECK(different == 0);
  }
}

TEST_CASE("Nothing in the way is full visibility, and the first two voxels are not looked at", "[shadow_volume]") {
  CHECK(ShadowVolume(layer(30)).visibility(start, up, 0.5f, 0.5f) == 1.0f);
  CHECK(ShadowVolume(layer(5)).visibility(start, up, 1.0f, 0.5f) == 1.0f);
  CHECK(ShadowVolume(layer(6)).visibility(start, up, 1.0f, 0.5f) < 1.0f);
}

TEST_CASE("A hit blocks hit^2 over its distance, in parts of the grid", "[shadow_volume]") {
  // At texel centres a layer is met once: at t = 8 / 32, then v = 0.1^2 / 0.25.
  CHECK(ShadowVolume(layer(12)).visibility(start, up, 1.0f, 0.1f) == Approx(1.0 - 0.01 / 0.25));
}

TEST_CASE("Voxels with weight 0 in the filter are no hit, those with any weight are", "[shadow_volume]") {
  const SurfaceGrid beside = occupied(size, [](const glm::ivec3& v) { return v.x == 17 && v.y > 8; });
  CHECK(ShadowVolume(beside).visibility(start, up, 1.0f, 0.1f) == 1.0f);
  const glm::vec3 nearer = start + glm::vec3(1.0f / 4096, 0, 0);
  CHECK(ShadowVolume(beside).visibility(nearer, up, 1.0f, 0.1f) < 1.0f);
}

TEST_CASE("A hit of exactly 1 blocks like any other; above 1 the first ends in darkness", "[shadow_volume]") {
  // The shader's test is s > 1 - 1e-30, and that is s > 1 in float32: v = 1 / 0.25 = 4, so 1 - 4 is left.
  const ShadowVolume wall(layer(12));
  CHECK(wall.visibility(start, up, 1.0f, 1.0f) == Approx(-3.0));
  CHECK(wall.visibility(start, up, 1.0f, 1.01f) == 0.0f);
}

TEST_CASE("Near hits make visibility negative", "[shadow_volume]") {
  // hit^2 / t = 0.25 / (2 / 32) = 4: v = 4 at once, and the march ends.
  CHECK(ShadowVolume(layer(6)).visibility(start, up, 1.0f, 0.5f) == Approx(-3.0));
}

TEST_CASE("Voxels whose count wrapped to 0 cast no shadow", "[shadow_volume]") {
  SurfaceGrid wrapped = layer(12);
  for (glm::vec4& albedo : wrapped.albedo) albedo.a = 0.0f;
  CHECK(ShadowVolume(wrapped).visibility(start, up, 1.0f, 0.5f) == 1.0f);
}

TEST_CASE("A flat grid's march ends at its sides", "[shadow_volume]") {
  const glm::ivec3 flat(32, 8, 32);
  const ShadowVolume roof(occupied(flat, [](const glm::ivec3& v) { return v.y == 7; }));
  const glm::vec3 from(0.5f, 1.5f / 32, 0.5f);
  CHECK(roof.visibility(from, up, 1.0f, 0.1f) < 1.0f);
  CHECK(roof.visibility(from, -up, 1.0f, 0.1f) == 1.0f);
}
