#include "cone/gather.h"

#include <glm/geometric.hpp>
#include <numbers>

#include "catch.h"
#include "cone/volumes.h"

using namespace voxref;

namespace {

constexpr float pi = std::numbers::pi_v<float>;

GatherPoint point_at(const glm::vec3& position, const glm::vec3& normal) { return {position, normal, normal}; }

Medium lit_box(const glm::ivec3& size) {
  return fill_medium(size, [&](const glm::ivec3& v) { return on_box(v, size, 1) ? glm::vec4(1.0f) : glm::vec4(0.0f); });
}

}  // namespace

TEST_CASE("A closed uniform box returns at least 0.98 of its radiance, for 6, 32 and 128 cones", "[gather]") {
  for (const glm::ivec3 size : {glm::ivec3(32, 32, 32), glm::ivec3(64, 64, 64), glm::ivec3(67, 45, 38)}) {
    const Medium medium = lit_box(size);
    for (const int count : {6, 32, 128}) {
      const ConeSet cones = pixel_cones(count);
      float sum = 0.0f, positions = 0.0f;
      for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
          for (const float across : {0.12f, 0.3f, 0.5f, 0.85f}) {
            glm::vec3 position = across * glm::vec3(size), normal(0.0f);
            position[axis] = sign > 0.0f ? 1.5f : float(size[axis]) - 1.5f;
            normal[axis] = sign;
            const glm::vec3 e =
                gather_diffuse(medium, cones, point_at(position, normal), {}, {}, glm::vec3(0.0f)).irradiance;
            CAPTURE(size.x, count, axis, sign, across);
            // Texels at the box's edges are up to 1/4 empty (outside of the walls): single cones lose more than the
            // mean.
            CHECK(e.r / pi >= 0.97f);
            CHECK(e.r / pi <= 1.0f + 1e-5f);  // nothing is brighter than the walls; weights sum to pi in float
            CHECK(e.r == e.g);
            sum += e.r / pi;
            positions += 1.0f;
          }
      CAPTURE(size.x, count);
      CHECK(sum / positions >= 0.98f);
    }
  }
}

TEST_CASE("A constant background over an unoccluded plane gives pi L", "[gather]") {
  const Medium medium = fill_medium(
      {32, 32, 32}, [](const glm::ivec3& v) { return v.y == 2 ? glm::vec4(0.0f, 0.0f, 0.0f, 1.0f) : glm::vec4(0.0f); });
  const glm::vec3 background(1.0f, 2.0f, 4.0f);
  for (const int count : {1, 4, 6, 16, 64}) {
    ConeOptions options;
    const glm::vec3 e =
        gather_diffuse(medium, pixel_cones(count), point_at({16.0f, 2.5f, 16.0f}, {0, 1, 0}), options, {}, background)
            .irradiance;
    CAPTURE(count);
    // The plane is black: what cones see of their own plane would be missing. Weights are summed in float.
    for (int c = 0; c < 3; ++c) CHECK(e[c] == Approx(pi * background[c]).epsilon(1e-5));
  }
}

TEST_CASE("The result hardly depends on the step: 0.5, 0.25 and 0.1 agree within 3 %", "[gather]") {
  const glm::ivec3 size(64, 64, 64);
  const Medium medium = fill_medium(size, [&](const glm::ivec3& v) {
    const bool block = v.x >= 30 && v.x < 40 && v.y >= 2 && v.y < 30 && v.z >= 20 && v.z < 40;
    if (block) return glm::vec4(0.2f, 0.2f, 0.2f, 1.0f);
    if (!on_box(v, size, 1)) return glm::vec4(0.0f);
    return v.x == 1 ? glm::vec4(0.9f, 0.1f, 0.1f, 1.0f) : glm::vec4(float(v.y) / 64.0f, 0.7f, 0.7f, 1.0f);
  });
  for (const int count : {6, 32}) {
    const ConeSet cones = pixel_cones(count);
    for (const glm::vec3 position :
         {glm::vec3(20.0f, 1.5f, 30.0f), glm::vec3(50.0f, 1.5f, 12.0f), glm::vec3(27.5f, 1.5f, 50.0f)}) {
      const auto irradiance = [&](float step) {
        ConeOptions options;
        options.step = step;
        return gather_diffuse(medium, cones, point_at(position, {0, 1, 0}), options, {}, glm::vec3(0.0f)).irradiance;
      };
      const glm::vec3 fine = irradiance(0.1f);
      for (const float step : {0.5f, 0.25f})
        for (int c = 0; c < 3; ++c) {
          CAPTURE(count, position.x, step, c);
          CHECK(irradiance(step)[c] == Approx(fine[c]).epsilon(0.03));
        }
    }
  }
}

TEST_CASE("Twice the radiance gives twice the irradiance, to the bit", "[gather]") {
  const glm::ivec3 size(32, 24, 20);
  const auto irradiance = [&](float scale) {
    const Medium medium = fill_medium(size, [&](const glm::ivec3& v) {
      return on_box(v, size, 1) ? glm::vec4(scale * glm::vec3(0.3f, 0.1f * float(v.y), 0.7f), 1.0f) : glm::vec4(0.0f);
    });
    return gather_diffuse(medium, pixel_cones(16), point_at({10.0f, 1.5f, 8.0f}, {0, 1, 0}), {}, {}, glm::vec3(0.0f))
        .irradiance;
  };
  CHECK(irradiance(2.0f) == 2.0f * irradiance(1.0f));
}

TEST_CASE("A specular cone sees what lies in the mirror direction", "[gather]") {
  const glm::ivec3 size(64, 64, 64);
  const Medium medium = fill_medium(size, [&](const glm::ivec3& v) {
    if (!on_box(v, size, 1)) return glm::vec4(0.0f);
    return v.x == 62 ? glm::vec4(1.0f, 0.0f, 0.0f, 1.0f) : glm::vec4(0.0f, 0.0f, 1.0f, 1.0f);
  });
  const GatherPoint floor = point_at({32.0f, 1.5f, 32.0f}, {0, 1, 0});
  const glm::vec3 from_left = glm::normalize(glm::vec3(-1.0f, 0.5f, 0.0f)), from_right(-from_left.x, from_left.y, 0.0f);
  const glm::vec3 red = gather_specular(medium, floor, from_left, specular_tan_half_angle(0.01f), {}, glm::vec3(0.0f));
  CHECK(red.r > 0.99f);
  CHECK(red.b < 0.01f);
  CHECK(gather_specular(medium, floor, from_right, specular_tan_half_angle(0.01f), {}, glm::vec3(0.0f)).b > 0.99f);
  // Mirrored to just below the ceiling, a wider lobe mixes both.
  const glm::vec3 from_below = glm::normalize(glm::vec3(-1.0f, 1.86f, 0.0f));
  const glm::vec3 sharp =
      gather_specular(medium, floor, from_below, specular_tan_half_angle(0.01f), {}, glm::vec3(0.0f));
  const glm::vec3 rough =
      gather_specular(medium, floor, from_below, specular_tan_half_angle(0.8f), {}, glm::vec3(0.0f));
  CHECK(sharp.b < 0.03f);  // it passes the corner within two voxels
  CHECK(rough.r > 0.1f);
  CHECK(rough.b > 0.01f);
  // A mirror direction behind the geometric surface carries nothing.
  const GatherPoint bent{floor.position, {0, 1, 0}, glm::normalize(glm::vec3(1.0f, 0.2f, 0.0f))};
  CHECK(gather_specular(medium, bent, {0, 1, 0}, specular_tan_half_angle(0.01f), {}, glm::vec3(1.0f)) ==
        glm::vec3(0.0f));
}

TEST_CASE("Openness is 1 in the open, 0 in a closed box without falloff, and between with it", "[gather]") {
  AoOptions ao;
  ao.enabled = true;
  const ConeSet cones = pixel_cones(16);
  const Medium empty = fill_medium({32, 32, 32}, [](const glm::ivec3&) { return glm::vec4(0.0f); });
  const GatherPoint floor = point_at({16.0f, 1.5f, 16.0f}, {0, 1, 0});
  CHECK(gather_diffuse(empty, cones, floor, {}, ao, glm::vec3(0.0f)).openness == 1.0f);

  const Medium box = lit_box({32, 32, 32});
  ao.falloff = 0.0f;
  CHECK(gather_diffuse(box, cones, floor, {}, ao, glm::vec3(0.0f)).openness < 0.02f);
  CHECK(openness(3.0f, ao) == 1.0f - 3.0f / std::numbers::pi_v<float>);
  ao.alpha = 1.0f;
  ao.normalized = false;
  CHECK(openness(3.0f, ao) == 1.0f);  // as the published shaders, which then gather no occlusion
  ao = {};
  ao.enabled = true;
  ao.falloff = 1.0f;
  const float near = gather_diffuse(box, cones, floor, {}, ao, glm::vec3(0.0f)).openness;
  ao.falloff = 10.0f;
  const float far = gather_diffuse(box, cones, floor, {}, ao, glm::vec3(0.0f)).openness;
  CHECK(near > 0.02f);
  CHECK(far > near);
  CHECK(far < 1.0f);
  ao.enabled = false;
  CHECK(gather_diffuse(box, cones, floor, {}, ao, glm::vec3(0.0f)).openness == 1.0f);
}

TEST_CASE("A cone to the light is cut by a wall and by nothing else", "[gather]") {
  const Medium medium = fill_medium({48, 48, 48}, [](const glm::ivec3& v) {
    const bool floor = v.y == 2, wall = v.x == 24 && v.y < 20;
    return floor || wall ? glm::vec4(0.0f, 0.0f, 0.0f, 1.0f) : glm::vec4(0.0f);
  });
  const GatherPoint floor = point_at({12.0f, 2.5f, 24.0f}, {0, 1, 0});
  CHECK(gather_visibility(medium, floor, {12.0f, 40.0f, 24.0f}, 0.03f, {}) == 1.0f);
  CHECK(gather_visibility(medium, floor, {40.0f, 10.0f, 24.0f}, 0.03f, {}) < 1e-3f);
  CHECK(gather_visibility(medium, floor, {4.0f, 6.0f, 24.0f}, 0.03f, {}) == 1.0f);
}
