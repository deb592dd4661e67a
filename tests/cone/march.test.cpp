#include "cone/march.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "catch.h"
#include "cone/cone_set.h"
#include "cone/volumes.h"

using namespace voxref;

namespace {

constexpr OwnPlane no_plane{};

MarchOptions stepping(float step) { return {step, glm::vec3(0.0f), 0.0f}; }

/// The march once more, plain and in double, from the formulas: every texel by its index, all six faces.
struct PlainMarch {
  const Medium& medium;
  bool leaps;  ///< steps begin anew where a gap ends, which Occupancy tells; only where there is no own plane

  glm::dvec4 texel(int level, const glm::ivec3& v, const glm::dvec3& d) const {
    if (level == 0) return glm::dvec4(medium.texels.base(v));
    const double cell = std::exp2(level);  // depths are those of the whole cell
    const double sum_of_axes = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    glm::dvec4 sum(0.0);
    for (int face = 0; face < 6; ++face) {
      const double along = (face % 2 ? 1.0 : -1.0) * d[face / 2];
      if (along > 0.0)
        sum += along / sum_of_axes / cell * glm::dvec4(medium.texels.levels[size_t(level - 1)](v)[size_t(face)]);
    }
    return sum;
  }
  glm::dvec4 trilinear(int level, glm::dvec3 p, const glm::dvec3& d) const {
    p = p / std::exp2(level) - 0.5;
    const glm::dvec3 first = glm::floor(p), f = p - first;
    glm::dvec4 sum(0.0);
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2);
      double weight = 1.0;
      for (int axis = 0; axis < 3; ++axis) weight *= corner[axis] ? f[axis] : 1.0 - f[axis];
      sum += weight * texel(level, glm::ivec3(first) + corner, d);
    }
    return sum;
  }
  ConeSample operator()(const glm::dvec3& apex, const glm::dvec3& d, double tangent, const OwnPlane& own,
                        const MarchOptions& options) const {
    const glm::ivec3& size = medium.texels.grid.size;
    const double widest = std::max(std::min({size.x, size.y, size.z}) / 4.0, std::max({size.x, size.y, size.z}) / 16.0);
    const double coarsest = std::max(widest, 1.0);
    // The way: from the apex along its plane, then from the surface point on.
    const glm::dvec3 n(own.normal), lift(own.lift);
    const double rise = glm::dot(n, d), lifted = glm::dot(n, lift);
    const bool descends = options.texel < 1.0f && lifted > 0.0 && rise > 0.0;
    const double descended = descends ? lifted / rise : 0.0;
    const auto position = [&](double s) {
      if (!descends) return apex + s * d;
      return apex - lift + s * d + (s < descended ? 1.0 - s / descended : 0.0) * lift;
    };
    const double reach = 1.5 * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    const auto side = [&](double s) {
      const double cone = std::clamp(2.0 * s * tangent * double(options.texel), 1.0, coarsest);
      if (reach == 0.0) return cone;
      const double height = glm::dot(n, position(s) - (apex - lift));
      return std::min(cone, std::exp2(std::floor(std::log2(std::max(height / reach, 1.0)))));
    };
    const glm::dvec3 from = position(1e6) - 1e6 * d, a = -from / d, b = (glm::dvec3(size) - from) / d;
    double end = std::min({std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)});
    end += 1.5 * side(end);
    glm::dvec3 radiance(0.0);
    double left = 1.0;
    for (double s = 0.0; s < end && left > 0.0;) {
      const double length = std::min(double(options.step) * side(s), end - s), middle = s + length / 2.0;
      const double level = std::log2(side(middle));
      const int k = int(level), coarser = int(std::ceil(level));
      const glm::vec3 p(position(middle)), way(d);
      if (leaps && !medium.occupied(coarser, to_float4(p))) {
        const Occupancy::Gap gap = medium.occupied.gap(coarser, to_float4(p), to_float4(way), 1.0f / to_float4(way));
        const double cell = std::exp2(gap.level), wide = cell >= coarsest ? 1e9 : cell / (2.0 * tangent);
        s = std::max(s + length, std::min(middle + double(gap.length), wide));
        continue;
      }
      glm::dvec4 sample = trilinear(k, position(middle), d);
      if (level > k) sample += (level - k) * (trilinear(k + 1, position(middle), d) - sample);
      s += length;
      if (sample.a == 0.0) continue;
      double absorbed = left * (1.0 - std::exp(-sample.a * length));
      left -= absorbed;
      if (left <= 1e-4) {
        absorbed += left;
        left = 0.0;
      }
      radiance += absorbed * glm::dvec3(sample) / sample.a;
    }
    ConeSample result;
    result.radiance = glm::vec3(radiance + left * glm::dvec3(options.background));
    result.opacity = float(1.0 - left);
    return result;
  }
};

glm::vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

/// Sparse random content: absent bricks, corners in several bricks, levels that stick out.
Medium sparse_medium(const glm::ivec3& size, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<glm::vec4> texels(size_t(size.x) * size_t(size.y) * size_t(size.z), glm::vec4(0.0f));
  for (glm::vec4& t : texels)
    if (uniform(random) < 0.02f) {
      t.a = uniform(random);
      for (int c = 0; c < 3; ++c) t[c] = t.a * 10.0f * uniform(random);
    }
  return fill_medium(size, [&](const glm::ivec3& v) {
    const bool empty_corner = v.x >= 16 && v.x < 96 && v.y >= 8 && v.z < 8;
    return empty_corner ? glm::vec4(0.0f) : texels[size_t(v.x + size.x * (v.y + size.y * v.z))];
  });
}

}  // namespace

TEST_CASE("A ray through an empty grid sees the background, to the bit", "[march]") {
  const Medium medium = fill_medium({24, 16, 8}, [](const glm::ivec3&) { return glm::vec4(0.0f); });
  const glm::vec3 background(0.1f, 2.0f, 3.7f);
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const ConeSample seen = march(medium, {12.0f, 8.0f, 4.0f}, random_direction(random), 0.1f * float(i % 10), no_plane,
                                  {0.5f, background, 0.0f});
    CHECK(seen.radiance == background);
    CHECK(seen.opacity == 0.0f);
  }
  // Starts outside, and never enters.
  CHECK(march(medium, {-5.0f, 8.0f, 4.0f}, {-1.0f, 0.0f, 0.0f}, 0.5f, no_plane, {0.5f, background, 0.0f}).radiance ==
        background);
}

TEST_CASE("The fast march agrees with a plain one in double, over bricks, borders, levels and directions", "[march]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const glm::ivec3 size(137, 26, 19);
  const Medium medium = sparse_medium(size, random);
  const PlainMarch plain{medium, true};
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 origin = glm::vec3(uniform(random), uniform(random), uniform(random)) * glm::vec3(size);
    const glm::vec3 direction = random_direction(random);
    const float tangent = i % 3 == 0 ? 0.0f : uniform(random);
    const MarchOptions options{i % 2 ? 0.5f : 0.1f, glm::vec3(1.0f, 2.0f, 3.0f), 0.0f};
    const ConeSample fast = march(medium, origin, direction, tangent, no_plane, options);
    const ConeSample slow = plain(origin, direction, tangent, no_plane, options);
    CAPTURE(i, tangent, options.step);
    // Float positions at 140 voxels are good to 1e-5 voxels, over which extinction changes by up to 9.2 x that, per
    // step; and a march may end at either side of transmittance 1e-4, which moves the rest (1e-4 of up to 10) to
    // another colour.
    CHECK(std::abs(fast.opacity - slow.opacity) < 2e-4f);
    for (int c = 0; c < 3; ++c) CHECK(std::abs(fast.radiance[c] - slow.radiance[c]) < 2e-3f);
  }
}

TEST_CASE("A march that leaps over gaps sees what one sees that takes every step, off any plane", "[march]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  const glm::ivec3 size(137, 46, 39);
  const Medium medium = sparse_medium(size, random);
  const PlainMarch plain{medium, false};
  for (int i = 0; i < 300; ++i) {
    OwnPlane own;
    own.normal = random_direction(random);
    own.lift = 12.0f * uniform(random) * own.normal;
    const glm::vec3 anywhere = glm::vec3(uniform(random), uniform(random), uniform(random)) * glm::vec3(size);
    const glm::vec3 apex = glm::clamp(anywhere, glm::vec3(12.5f), glm::vec3(size) - 12.5f) + own.lift;
    const glm::vec3 direction = random_direction(random);
    const glm::vec3 upward = glm::dot(direction, own.normal) < 0.0f ? -direction : direction;
    // Half a cone's width: the march descends.
    const MarchOptions options{0.02f, glm::vec3(0.0f), 0.0f, i % 3 == 0 ? 1.0f : 0.5f};
    const float tangent = 0.1f + uniform(random);
    const ConeSample fast = march(medium, apex, upward, tangent, own, options);
    const ConeSample slow = plain(apex, upward, tangent, own, options);
    CAPTURE(i, tangent, options.texel, glm::length(own.lift));
    // They sample at other places of their steps of 0.02 texels: 0.003 apart at the most. A leap that passes by what
    // coarser texels hold is wrong by 0.02.
    CHECK(std::abs(fast.opacity - slow.opacity) < 0.006f);
  }
}

TEST_CASE("A one-voxel opaque wall facing the axis transmits less than 0.1 % at any step and sub-voxel offset",
          "[march]") {
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      const Medium medium = fill_medium({32, 32, 32}, [&](const glm::ivec3& v) {
        return v[axis] == 17 ? glm::vec4(0.0f, 0.0f, 0.0f, 1.0f) : glm::vec4(0.0f);
      });
      glm::vec3 direction(0.0f);
      direction[axis] = sign;
      for (const float step : {0.5f, 0.25f, 0.1f})
        for (const float tangent : {0.0f, 0.05f, 0.3f, 0.663f})
          for (int i = 0; i < 16; ++i) {
            glm::vec3 origin(15.3f, 16.1f, 14.9f);
            origin[axis] = (sign > 0.0f ? 5.0f : 27.0f) + float(i) / 16.0f;
            CAPTURE(axis, sign, step, tangent, i);
            CHECK(1.0f - march(medium, origin, direction, tangent, no_plane, stepping(step)).opacity < 1e-3f);
          }
    }
}

TEST_CASE("Many short steps through a homogeneous medium equal one long one, and the closed form", "[march]") {
  const float opacity = 0.02f, distance = 20.0f;
  const Medium medium =
      fill_medium({64, 64, 64}, [&](const glm::ivec3&) { return glm::vec4(glm::vec3(opacity * 2.0f), opacity); });
  const double transmitted = std::pow(1.0 - opacity, double(distance));
  for (const float tangent : {0.0f, 0.3f, 1.0f})
    for (const float step : {4.0f, 1.0f, 0.5f, 0.1f, 0.01f}) {
      CAPTURE(tangent, step);
      const glm::vec3 direction = glm::normalize(glm::vec3(1.0f, 2.0f, -0.5f));
      // Starting behind the middle, so that wide samples at the far end keep clear of the border (20 voxels at most).
      const ConeSample seen =
          march(medium, {27.0f, 22.0f, 37.0f}, direction, tangent, no_plane, stepping(step), distance);
      // Level texels hold 1 - (1 - a)^(2^k) in float, whose logarithm is good to 1e-5; 2000 products round to 1e-4.
      const bool inside = tangent * step < 1.0f && tangent < 1.0f;
      if (inside || step <= 0.5f || tangent == 0.0f) {
        CHECK(1.0 - seen.opacity == Approx(transmitted).epsilon(tangent < 1.0f ? 2e-4 : 0.05));
        CHECK(seen.radiance.r == Approx(2.0f * seen.opacity).epsilon(2e-4));
      }
    }
}

TEST_CASE("A cone reads the level whose texels are as wide as it is", "[march]") {
  // One level holds extinction, all others none: light is seen where, and only where, the cone is about that wide.
  const glm::ivec3 size(128, 128, 128);
  const float tangent = 0.25f;  // diameter = s / 2
  for (int level = 0; level <= 4; ++level) {
    Medium medium = fill_medium(size, [](const glm::ivec3&) { return glm::vec4(0.5f); });
    for (glm::vec4& texel : medium.texels.base.texels()) texel = level == 0 ? glm::vec4(1.0f) : glm::vec4(0.0f);
    for (int k = 1; k <= medium.top(); ++k)
      for (DirectionalTexel& texel : medium.texels.levels[size_t(k - 1)].texels())
        texel.fill(k == level ? glm::vec4(1.0f) : glm::vec4(0.0f));
    const auto opacity = [&](float distance) {
      return march(medium, {10.0f, 64.0f, 64.0f}, {1.0f, 0.0f, 0.0f}, tangent, no_plane, stepping(0.05f), distance)
          .opacity;
    };
    // It fades in from level - 1, where the diameter is 2^(level-1), to level, and out to level + 1.
    const float begin = level == 0 ? 0.0f : 2.0f * std::exp2(float(level - 1)), full = 2.0f * std::exp2(float(level));
    CAPTURE(level);
    if (level > 0) CHECK(opacity(begin * 0.99f) == 0.0f);
    CHECK(opacity(full) > opacity(begin));
    CHECK(opacity(2.0f * full) > opacity(full));
    CHECK(opacity(3.0f * full) == Approx(opacity(2.2f * full)).epsilon(1e-6));
  }
}

TEST_CASE("Samples whose filter would reach the gathering surface come from a finer level", "[march]") {
  // A lit floor in voxel layer 4. A cone that rises from it at any angle must not see it.
  const Medium medium =
      fill_medium({64, 64, 64}, [](const glm::ivec3& v) { return v.z == 4 ? glm::vec4(1.0f) : glm::vec4(0.0f); });
  const glm::vec3 normal(0.0f, 0.0f, 1.0f);
  const float floor = 4.5f;  // the surface passes through the middle of its voxels
  for (const float elevation : {0.2f, 0.5f, 0.8f, 1.2f, 1.5f})
    for (const float tangent : {0.1f, 0.3f, 0.663f}) {
      CAPTURE(elevation, tangent);
      const glm::vec3 direction(std::cos(elevation), 0.0f, std::sin(elevation));
      const glm::vec3 apex(20.0f, 32.0f, floor + 1.5f);
      CHECK(march(medium, apex, direction, tangent, {normal, 1.5f * normal}, stepping(0.5f)).radiance.r < 0.02f);
      if (tangent > 0.5f && elevation < 0.9f)  // what the rule is for
        CHECK(march(medium, apex, direction, tangent, no_plane, stepping(0.5f)).radiance.r > 0.1f);
    }
}

TEST_CASE("A cone ends at its greatest distance and leaves the background out there", "[march]") {
  const Medium medium =
      fill_medium({32, 32, 32}, [](const glm::ivec3& v) { return v.x == 20 ? glm::vec4(1.0f) : glm::vec4(0.0f); });
  CHECK(march_opacity(medium, {10.5f, 16.0f, 16.0f}, {19.4f, 16.0f, 16.0f}, 0.0f, 0.5f) == 0.0f);
  CHECK(march_opacity(medium, {10.5f, 16.0f, 16.0f}, {22.0f, 16.0f, 16.0f}, 0.0f, 0.5f) > 0.999f);
  CHECK(march_opacity(medium, {10.5f, 16.0f, 16.0f}, {10.5f, 16.0f, 16.0f}, 0.0f, 0.5f) == 0.0f);
  // Behind the wall's tent, from outside of the grid on, half the wall's extinction is left at its centre.
  CHECK(march_opacity(medium, {-50.0f, 16.0f, 16.0f}, {20.5f, 16.0f, 16.0f}, 0.0f, 0.1f) ==
        Approx(0.99f).epsilon(1e-3));
  CHECK(march(medium, {10.5f, 16.0f, 16.0f}, {-1.0f, 0.0f, 0.0f}, 0.0f, no_plane, {0.5f, glm::vec3(7.0f), 0.0f}, 5.0f)
            .radiance == glm::vec3(0.0f));
}

TEST_CASE("Permuting the axes of volume, origin and direction permutes nothing in what is seen", "[march]") {
  const glm::ivec3 size(24, 24, 24);
  const auto texel = [](const glm::ivec3& v) {
    const uint32_t hash = uint32_t(v.x * 73856093) ^ uint32_t(v.y * 19349663) ^ uint32_t(v.z * 83492791);
    return hash % 16 == 0 ? glm::vec4(float(hash % 7), float(hash % 5), 1.0f, 1.0f) : glm::vec4(0.0f);
  };
  const glm::vec3 origin(11.3f, 12.9f, 10.2f), direction = glm::normalize(glm::vec3(0.9f, -0.3f, 0.5f));
  const ConeSample straight = march(fill_medium(size, texel), origin, direction, 0.2f, no_plane, stepping(0.5f));
  const Medium turned = fill_medium(size, [&](const glm::ivec3& v) { return texel({v.y, v.z, v.x}); });
  const ConeSample seen = march(turned, {origin.z, origin.x, origin.y}, {direction.z, direction.x, direction.y}, 0.2f,
                                no_plane, stepping(0.5f));
  // Interpolation takes the axes in another order: rounding only.
  for (int c = 0; c < 3; ++c) CHECK(seen.radiance[c] == Approx(straight.radiance[c]).epsilon(1e-4));
  CHECK(seen.opacity == Approx(straight.opacity).epsilon(1e-5));
}

TEST_CASE("Occlusion counts what lies near more than what lies far", "[march]") {
  const Medium medium =
      fill_medium({32, 32, 32}, [](const glm::ivec3& v) { return v.x == 20 ? glm::vec4(1.0f) : glm::vec4(0.0f); });
  const glm::vec3 origin(10.5f, 16.5f, 16.5f), along(1.0f, 0.0f, 0.0f);
  const ConeSample plain = march(medium, origin, along, 0.0f, no_plane, {0.1f, glm::vec3(0.0f), 0.0f});
  CHECK(plain.occlusion == Approx(plain.opacity).epsilon(1e-5));
  const ConeSample faded = march(medium, origin, along, 0.0f, no_plane, {0.1f, glm::vec3(0.0f), 0.5f});
  // The wall's opacity lies within a voxel before its centre at distance 10: 1/(1 + 0.5 x 9.5) within 5 %.
  CHECK(faded.occlusion == Approx(1.0 / (1.0 + 0.5 * 9.5)).epsilon(0.05));
}
