#include "cone/raw_march.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "catch.h"
#include "cone/volumes.h"

using namespace voxref;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// The march once more, slowly and in double precision: every texel is clamped and fetched on its own.
class PlainMarch {
 public:
  explicit PlainMarch(const Pyramid8& pyramid) : pyramid_(pyramid) {}

  glm::dvec4 sample(const glm::dvec3& p, double level, const glm::dvec3& direction) const {
    const int finer = static_cast<int>(level);
    const double f = level - finer;
    const glm::dvec4 a = trilinear(p, finer, direction);
    return f == 0.0 ? a : glm::mix(a, trilinear(p, finer + 1, direction), f);
  }

 private:
  glm::dvec4 texel(glm::ivec3 v, int level, const glm::dvec3& direction) const {
    const auto bytes = [](const Rgba8& t) {
      return glm::dvec4(t.bytes[0], t.bytes[1], t.bytes[2], t.bytes[3]) / 255.0;
    };
    if (level == 0) return bytes(pyramid_.base(glm::clamp(v, glm::ivec3(0), pyramid_.base.size() - 1)));
    const auto& volume = pyramid_.levels[size_t(level - 1)];
    const auto& faces = volume(glm::clamp(v, glm::ivec3(0), volume.size() - 1));
    glm::dvec4 sum(0.0);
    for (int axis = 0; axis < 3; ++axis)
      sum += direction[axis] * direction[axis] * bytes(faces[size_t(2 * axis + (direction[axis] >= 0.0))]);
    return sum;
  }
  glm::dvec4 trilinear(const glm::dvec3& p, int level, const glm::dvec3& direction) const {
    const glm::dvec3 q = p / double(1 << level) - 0.5, low = glm::floor(q), f = q - low;
    glm::dvec4 sum(0.0);
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
      const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(corner));
      sum += w.x * w.y * w.z * texel(glm::ivec3(low) + corner, level, direction);
    }
    return sum;
  }
  const Pyramid8& pyramid_;
};

/// Voxels of random colour; one in `rarity` is occupied.
Pyramid8 random_volume(int size, int rarity) {
  std::mt19937 random(7);
  const BrickVolume<glm::vec4> values = fill(glm::ivec3(size), [&](const glm::ivec3&) {
    if (random() % unsigned(rarity) != 0) return glm::vec4(0.0f);
    return glm::vec4(float(random() % 256), float(random() % 256), float(random() % 256), 255.0f) / 255.0f;
  });
  BrickVolume<Rgba8> base(values.size());
  std::vector<glm::ivec3> bricks;
  for (int z = 0; z < size / 8; ++z)
    for (int y = 0; y < size / 8; ++y)
      for (int x = 0; x < size / 8; ++x) bricks.emplace_back(x, y, z);
  base.allocate(bricks);
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) base({x, y, z}) = encode<Rgba8>(load(std::as_const(values)(glm::ivec3(x, y, z))));
  return mipmap(unit_grid(glm::ivec3(size)), std::move(base), MipmapOptions{});
}

/// A volume whose voxels at x in [begin, end) have the opacity `alpha`; the rest is empty.
Pyramid slab(int begin, int end, float alpha) {
  return mipmap(
      unit_grid(glm::ivec3(32)),
      fill(glm::ivec3(32),
           [&](const glm::ivec3& v) { return v.x >= begin && v.x < end ? glm::vec4(alpha) : glm::vec4(0.0f); }),
      MipmapOptions{});
}

ConeStepping stepping(float unit, float step, float end, int top) {
  ConeStepping s;
  s.unit = unit, s.step = step, s.end = end, s.top = top;
  return s;
}

const glm::vec3 along_x(1.0f, 0.0f, 0.0f);

}  // namespace

TEST_CASE("Steps grow by a constant factor, levels by its logarithm", "[raw_march]") {
  const auto steps = cone_steps(0.57735f, stepping(2.0f, 0.5f, 30.0f, 3));
  REQUIRE(steps.size() == 6);
  for (size_t i = 0; i < steps.size(); ++i) {
    const double distance = 2.0 * std::pow(1.0 + 0.57735, double(i));  // s += 0.5 x 2 s tan
    CHECK(steps[i].distance == Approx(distance).epsilon(1e-5));
    const double level = std::min(std::log2(2.0 * 0.57735 * distance / 2.0), 3.0);
    CHECK(steps[i].level + double(steps[i].fraction) == Approx(level).epsilon(1e-4));
    CHECK(steps[i].occlusion == 1.0f);
  }
  CHECK(steps.front().level == 0);  // d = 1.15 w lies between the base and the first level
  CHECK(steps.front().fraction == Approx(std::log2(1.1547)).epsilon(1e-4));
  CHECK(cone_steps(0.03f, stepping(2.0f, 0.5f, 30.0f, 3)).front().fraction == 0.0f);  // narrower than a texel: the base
}

TEST_CASE("Opacity in a wide part of the cone counts less towards occlusion", "[raw_march]") {
  ConeStepping s = stepping(1.0f, 0.5f, 10.0f, 3);
  s.falloff = 2.0f;
  for (const ConeStep& step : cone_steps(0.5f, s))
    CHECK(step.occlusion == Approx(1.0f / (1.0f + 2.0f * 0.5f * step.distance)).epsilon(1e-6));
}

TEST_CASE("The march through bricks of bytes is that of every texel on its own", "[raw_march]") {
  const Pyramid8 pyramid = random_volume(32, 40);
  const PlainMarch plain(pyramid);
  const Occupancy occupied(pyramid);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> anywhere(-4.0f, 36.0f), component(-1.0f, 1.0f);  // outside the volume too
  for (const float tangent : {0.03f, 0.2f, 0.57735f, 3.0f}) {
    ConeStepping stepped = stepping(2.0f, 0.5f, 30.0f, 5);
    stepped.falloff = 0.1f;
    const auto steps = cone_steps(tangent, stepped);
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 start(anywhere(random), anywhere(random), anywhere(random));
      const glm::vec3 direction = glm::normalize(glm::vec3(component(random), component(random), component(random)));
      glm::dvec4 sum(0.0);
      double occlusion = 0.0;
      for (const ConeStep& step : steps) {
        const glm::dvec4 c = plain.sample(glm::dvec3(start) + double(step.distance) * glm::dvec3(direction),
                                          step.level + double(step.fraction), direction);
        sum += (1.0 - sum.a) * c;
        occlusion += (1.0 - occlusion) * c.a * double(step.occlusion);
        if (sum.a >= 1.0) break;
      }
      const RawCone cone = march_raw(pyramid, occupied, ConeAxis(start, direction), {steps, 1.0f});
      constexpr double rounding = 1e-4;  // positions of up to 36 in float32, over up to a hundred samples
      CHECK(glm::distance(glm::dvec3(cone.radiance), glm::dvec3(sum)) < rounding);
      CHECK(std::abs(cone.opacity - sum.a) < rounding);
      CHECK(std::abs(cone.occlusion - occlusion) < rounding);
    }
  }
}

TEST_CASE("Bytes and floats of the same values march alike", "[raw_march]") {
  const Pyramid8 bytes = random_volume(16, 4);
  Pyramid floats;
  floats.grid = bytes.grid;
  const auto widened = [](const auto& volume, auto&& each) {
    BrickVolume<std::decay_t<decltype(each(volume.texels()[0]))>> wide(volume.size());
    std::vector<glm::ivec3> bricks;
    for (int z = 0; z < volume.brick_grid().z; ++z)
      for (int y = 0; y < volume.brick_grid().y; ++y)
        for (int x = 0; x < volume.brick_grid().x; ++x)
          if (volume.slot({x, y, z}) != volume.absent) bricks.emplace_back(x, y, z);
    wide.allocate(bricks);
    for (size_t i = 0; i < wide.texels().size(); ++i) wide.texels()[i] = each(volume.texels()[i]);
    return wide;
  };
  floats.base = widened(bytes.base, [](const Rgba8& t) { return to_vec4(decode(t)); });
  for (const auto& level : bytes.levels)
    floats.levels.push_back(widened(level, [](const Directional<Rgba8>& t) {
      DirectionalTexel wide;
      for (size_t face = 0; face < 6; ++face) wide[face] = to_vec4(decode(t[face]));
      return wide;
    }));
  const auto steps = cone_steps(0.57735f, stepping(2.0f, 0.5f, 15.0f, 4));
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));
  const ConeAxis axis({8.0f, 12.0f, 2.0f}, direction);
  const RawCone a = march_raw(bytes, Occupancy(bytes), axis, {steps, 1.0f});
  const RawCone b = march_raw(floats, Occupancy(floats), axis, {steps, 1.0f});
  CHECK(a.opacity > 0.0f);
  for (int c = 0; c < 3; ++c) CHECK(a.radiance[c] == Approx(b.radiance[c]).epsilon(1e-6));
}

TEST_CASE("Raw opacity depends on the step: half-opaque fog lets .5, .25, .0625, .001 through", "[raw_march]") {
  const Pyramid fog = slab(0, 32, 0.5f);
  // One voxel's length in steps of 1, 1/2, 1/4, 1/10 voxel, all at the base level.
  for (const int samples : {1, 2, 4, 10}) {
    std::vector<ConeStep> steps;
    for (int i = 0; i < samples; ++i) steps.push_back({float(i) / float(samples), 0, 0.0f, 1.0f});
    const RawCone cone = march_raw(fog, Occupancy(fog), ConeAxis({8.0f, 16.0f, 16.0f}, along_x), {steps, 1.0f});
    CHECK(1.0f - cone.opacity == Approx(std::pow(0.5f, float(samples))).epsilon(1e-5));
  }
}

TEST_CASE("Outside the volume a raw cone goes on seeing its edge", "[raw_march]") {
  const Pyramid edge = slab(31, 32, 0.5f);
  const ConeSteps far({{100.0f, 0, 0.0f, 1.0f}}, 1.0f);
  const Occupancy occupied(edge);
  CHECK(march_raw(edge, occupied, ConeAxis({16.0f, 16.0f, 16.0f}, along_x), far).opacity == 0.5f);
  CHECK(march_raw(edge, occupied, ConeAxis({16.0f, 16.0f, 16.0f}, -along_x), far).opacity == 0.0f);
}

TEST_CASE("A shadow cone multiplies opacity by its gain, and ends at the light", "[raw_march]") {
  const Pyramid thin = slab(16, 17, 0.25f);
  const ConeSteps steps({{1.0f, 0, 0.0f, 1.0f}, {8.5f, 0, 0.0f, 1.0f}, {12.0f, 0, 0.0f, 1.0f}}, 1.0f);
  const glm::vec3 start(8.0f, 16.0f, 16.0f);
  const ConeAxis forth(start, along_x), back(start, -along_x);
  const Occupancy occupied(thin);
  CHECK(march_raw_shadow(thin, occupied, forth, steps, 20.0f, 1.0f) == 0.75f);
  CHECK(march_raw_shadow(thin, occupied, forth, steps, 20.0f, 2.0f) == 0.5f);
  CHECK(march_raw_shadow(thin, occupied, forth, steps, 20.0f, 8.0f) == 0.0f);  // never below 0
  CHECK(march_raw_shadow(thin, occupied, forth, steps, 8.0f, 1.0f) == 1.0f);   // the light is before the slab
  CHECK(march_raw_shadow(thin, occupied, forth, steps, 20.0f, infinity) == 0.0f);
  CHECK(march_raw_shadow(thin, occupied, back, steps, 20.0f, infinity) == 1.0f);
}

TEST_CASE("A shadow cone that skips empty space sees what one sees that does not", "[raw_march]") {
  const Pyramid8 pyramid = random_volume(32, 60);
  const PlainMarch plain(pyramid);
  const Occupancy occupied(pyramid);
  const auto steps = cone_steps(0.03f, stepping(2.0f, 0.5f, 30.0f, 5));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> anywhere(-2.0f, 34.0f), component(-1.0f, 1.0f);
  int shadowed = 0;
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 start(anywhere(random), anywhere(random), anywhere(random));
    const glm::vec3 direction = glm::normalize(glm::vec3(component(random), component(random), component(random)));
    const ConeAxis axis(start, direction);
    double blocked = 0.0;
    for (const ConeStep& step : steps)
      blocked += (1.0 - blocked) * 0.25 *
                 plain
                     .sample(glm::dvec3(start) + double(step.distance) * glm::dvec3(direction),
                             step.level + double(step.fraction), direction)
                     .a;
    shadowed += blocked > 0.0;
    // Rounding of positions up to 36 in float32, over a hundred samples.
    CHECK(march_raw_shadow(pyramid, occupied, axis, {steps, 1.0f}, 30.0f, 0.25f) == Approx(1.0 - blocked).margin(1e-4));
    // Whether there is any opacity at all is told by a look-up, not by its rounding.
    const float hard = march_raw_shadow(pyramid, occupied, axis, {steps, 1.0f}, 30.0f, infinity);
    if (blocked > 1e-4) CHECK(hard == 0.0f);
    if (blocked == 0.0) CHECK(hard == 1.0f);
  }
  CHECK(shadowed > 30);
  CHECK(shadowed < 290);
}

TEST_CASE("A ray meets a box unless it leaves it where it starts", "[raw_march]") {
  Bounds box;
  box.min = glm::vec3(0.0f), box.max = glm::vec3(1.0f);
  CHECK(meets(box, glm::vec3(0.5f), along_x));
  CHECK(meets(box, {-1.0f, 0.5f, 0.5f}, along_x));
  CHECK_FALSE(meets(box, {-1.0f, 0.5f, 0.5f}, -along_x));
  CHECK_FALSE(meets(box, {2.0f, 0.5f, 0.5f}, along_x));
  CHECK_FALSE(meets(box, {1.0f, 0.5f, 0.5f}, along_x));  // on a wall, outwards
  CHECK(meets(box, {1.0f, 0.5f, 0.5f}, -along_x));
  CHECK_FALSE(meets(box, {0.5f, 1.5f, 0.5f}, along_x));
}
