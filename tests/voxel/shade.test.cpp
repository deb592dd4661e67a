#include "voxel/shade.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "catch.h"
#include "parallel.h"
#include "voxel/mesh_scene.h"

using namespace voxref;

namespace {

constexpr double pi = 3.14159265358979324;

/// A horizontal square at height y over [x0,x1]^2, front upwards.
Mesh floor_at(float y, float x0, float x1) { return quad({x0, y, x0}, {x0, y, x1}, {x1, y, x1}, {x1, y, x0}); }

Light spot(const glm::vec3& position, const glm::vec3& direction, float cos_inner, float cos_outer) {
  Light light = point_light("spot", position, glm::vec3(100));
  light.type = LightType::spot;
  light.direction = glm::normalize(direction);
  light.cos_inner = cos_inner;
  light.cos_outer = cos_outer;
  return light;
}

struct Shaded {
  SurfaceGrid surfaces;
  std::vector<glm::vec3> radiance;
};

Shaded shaded(const Scene& scene, const Grid& grid, VoxelShadow shadow = VoxelShadow::rays) {
  const Caster caster(scene);
  Shaded result{voxelize(scene, grid, {}), {}};
  ShadeOptions options;
  options.shadow = shadow;
  result.radiance = shade(scene, &caster, result.surfaces, {}, options).radiance;
  return result;
}

/// Largest relative difference of the red channel from `expected`, a function of the centroid.
template <class Expected>
double deviation(const Shaded& result, Expected&& expected) {
  double worst = 0.0;
  for (size_t i = 0; i < result.surfaces.size(); ++i) {
    const double wanted = expected(glm::dvec3(result.surfaces.centroid[i]));
    worst = std::max(worst, std::abs(result.radiance[i].r - wanted) / std::max(wanted, 1e-3));
  }
  return worst;
}

/// Relative: some ten float32 roundings from the light's distance to the radiance.
constexpr double rounding = 2e-6;

const Grid grid16 = unit_grid(glm::ivec3(16));

}  // namespace

TEST_CASE("a point light gives albedo/pi x I cos / d^2", "[shade]") {
  Scene scene = scene_of(floor_at(2.5f, 2.0f, 14.0f));
  scene.lights = {point_light("lamp", {6.0f, 9.0f, 7.0f}, {100.0f, 50.0f, 25.0f})};
  const Shaded result = shaded(scene, grid16);
  CHECK(result.surfaces.size() == 144);
  CHECK(deviation(result, [](const glm::dvec3& p) {
          const glm::dvec3 to_light = glm::dvec3(6, 9, 7) - p;
          return 0.5 / pi * 100.0 * to_light.y / std::pow(glm::length(to_light), 3.0);
        }) < rounding);
  for (const glm::vec3& radiance : result.radiance) CHECK(radiance == radiance.r * glm::vec3(1.0f, 0.5f, 0.25f));
}

TEST_CASE("a directional light gives albedo/pi x E cos, on a slope too", "[shade]") {
  Scene scene = scene_of(quad({2, 2, 2}, {2, 2, 14}, {14, 11, 14}, {14, 11, 2}));  // normal (-3,4,0)/5
  scene.lights = {sun("sun", {0, -1, 0}, glm::vec3(10))};
  CHECK(deviation(shaded(scene, grid16), [](const glm::dvec3&) { return 0.5 / pi * 10.0 * 0.8; }) < rounding);
}

TEST_CASE("a spot light ends at its outer cone", "[shade]") {
  Scene scene = scene_of(floor_at(2.5f, 2.0f, 14.0f));
  scene.lights = {spot({8, 10, 8}, {0, -1, 0}, 0.95f, 0.85f)};
  const Shaded result = shaded(scene, grid16);
  size_t dark = 0, partly = 0;
  CHECK(deviation(result, [&](const glm::dvec3& p) {
          const glm::dvec3 to_light = glm::dvec3(8, 10, 8) - p;
          const double cosine = to_light.y / glm::length(to_light);
          const double ramp = std::clamp((cosine - 0.85f) / (0.95f - 0.85f), 0.0, 1.0);
          dark += ramp == 0.0;
          partly += ramp > 0.0 && ramp < 1.0;
          return 0.5 / pi * 100.0 * cosine * ramp * ramp / glm::dot(to_light, to_light);
        }) < 4e-5);  // the ramp magnifies a rounding of the cosine tenfold, and is squared, and starts at 0
  CHECK(dark > 20);
  CHECK(partly > 20);
}

TEST_CASE("twice the light gives exactly twice the radiance, and lights add up", "[shade]") {
  Scene scene = scene_of(floor_at(2.5f, 2.0f, 14.0f));
  const Light lamp = point_light("lamp", {6, 9, 7}, glm::vec3(100)), sky = sun("sky", {1, -2, 0}, glm::vec3(3));
  const auto with = [&](std::vector<Light> lights) {
    scene.lights = std::move(lights);
    return shaded(scene, grid16).radiance;
  };
  Light twice = lamp;
  twice.intensity *= 2.0f;
  const auto first = with({lamp}), second = with({sky}), both = with({lamp, sky}), doubled = with({twice});
  for (size_t i = 0; i < first.size(); ++i) {
    CHECK(doubled[i] == 2.0f * first[i]);
    CHECK(glm::distance(both[i], first[i] + second[i]) < 1e-6f * glm::length(both[i]));
  }
  for (const glm::vec3& radiance : with({})) CHECK(radiance == glm::vec3(0));
}

TEST_CASE("light from behind a surface does not show on its front", "[shade]") {
  Scene scene = scene_of(floor_at(8.5f, 2.0f, 14.0f));
  scene.lights = {point_light("above", {8, 14, 8}, glm::vec3(100))};
  for (const glm::vec3& radiance : shaded(scene, grid16).radiance) CHECK(radiance.r > 0.0f);
  scene.lights = {point_light("below", {8, 3, 8}, glm::vec3(100))};
  for (const glm::vec3& radiance : shaded(scene, grid16).radiance) CHECK(radiance == glm::vec3(0.0f));
}

TEST_CASE("emission is added, and shines without light", "[shade]") {
  Scene scene = scene_of(floor_at(2.5f, 2, 14), emitter("lamp", glm::vec3(0.5f), {1, 2, 3}));
  for (const glm::vec3& radiance : shaded(scene, grid16).radiance) CHECK(radiance == glm::vec3(1, 2, 3));
  scene.lights = {sun("sun", {0, -1, 0}, glm::vec3(float(2.0 * pi)))};
  for (const glm::vec3& radiance : shaded(scene, grid16).radiance)
    CHECK(glm::distance(radiance, glm::vec3(2, 3, 4)) < 1e-5f);
}

TEST_CASE("a roof casts its shadow on the floor, by rays to the bit", "[shade]") {
  Scene scene = scene_of(floor_at(2.5f, 2, 14));
  add_object(scene, "roof", floor_at(6.5f, 6, 10), 0);
  scene.lights = {sun("sun", {0, -1, 0}, glm::vec3(10))};
  const Shaded rays = shaded(scene, grid16), volume = shaded(scene, grid16, VoxelShadow::volume),
               none = shaded(scene, grid16, VoxelShadow::none);
  size_t dark = 0;
  for (size_t i = 0; i < rays.surfaces.size(); ++i) {
    const glm::ivec3 v = rays.surfaces.voxels[i];
    const bool below = v.y < 6 && v.x >= 6 && v.x < 10 && v.z >= 6 && v.z < 10;
    dark += below;
    CHECK(rays.radiance[i] == (below ? glm::vec3(0) : none.radiance[i]));
    // Interpolation between voxels blurs the shadow's border by a voxel to either side.
    const bool deep = below && v.x > 6 && v.x < 9 && v.z > 6 && v.z < 9;
    const bool clear = v.y == 6 || v.x < 5 || v.x > 10 || v.z < 5 || v.z > 10;
    if (deep) CHECK(volume.radiance[i].r < 0.01f * none.radiance[i].r);
    if (clear) CHECK(volume.radiance[i].r > 0.99f * none.radiance[i].r);
  }
  CHECK(dark == 16);
}

TEST_CASE("a point light shines no further than an obstacle, and obstacles behind it cast none", "[shade]") {
  Scene scene = scene_of(floor_at(2.5f, 2, 14));
  scene.lights = {point_light("lamp", {8, 6, 8}, glm::vec3(100))};
  const Shaded free = shaded(scene, grid16);
  add_object(scene, "ceiling", floor_at(8.5f, 2, 14), 0);
  const Shaded below_ceiling = shaded(scene, grid16);
  add_object(scene, "screen", floor_at(4.5f, 2, 14), 0);
  const Shaded screened = shaded(scene, grid16);
  for (size_t i = 0, j = 0, k = 0; i < free.surfaces.size(); ++i) {
    while (below_ceiling.surfaces.voxels[j] != free.surfaces.voxels[i]) ++j;
    while (screened.surfaces.voxels[k] != free.surfaces.voxels[i]) ++k;
    CHECK(below_ceiling.radiance[j] == free.radiance[i]);
    CHECK(screened.radiance[k] == glm::vec3(0));
  }
}

// At a convex edge the centroid lies inside the solid. Whatever the place of the edge in its voxel, the ray must get
// out.
TEST_CASE("edges and corners of a solid do not shade themselves", "[shade]") {
  const glm::vec3 travel = glm::normalize(glm::vec3(-1.0f, -1.3f, -0.8f));
  size_t inside = 0;
  for (int step = 0; step < 16; ++step) {
    const float corner = 11.0f + (float(step) + 0.5f) / 16.0f;  // every place within voxel 11
    Scene scene = scene_of(box(glm::vec3(4.25f), glm::vec3(corner)));
    scene.lights = {sun("sun", travel, glm::vec3(10))};
    const Caster caster(scene);
    const Shaded result = shaded(scene, grid16);
    for (size_t i = 0; i < result.surfaces.size(); ++i) {
      const glm::ivec3 v = result.surfaces.voxels[i];
      const glm::vec3 normal = glm::normalize(result.surfaces.normal[i]);
      const bool towards_light = v.x == 11 || v.y == 11 || v.z == 11;
      const bool away = v.x == 4 || v.y == 4 || v.z == 4;
      if (towards_light && !away) {
        inside += caster.occluded({result.surfaces.centroid[i] + 1e-3f * normal, -travel});
        CHECK(result.radiance[i].r == Approx(0.5 / pi * 10.0 * std::abs(glm::dot(normal, -travel))).epsilon(rounding));
      }
      if (away && !towards_light) CHECK(result.radiance[i] == glm::vec3(0));
    }
  }
  CHECK(inside > 100);  // the centroid itself would have been a bad place to start
}

TEST_CASE("a sheet thinner than a voxel is lit from both sides with half the cosine", "[shade]") {
  for (const float light_height : {14.0f, 2.0f}) {
    Scene scene = scene_of(box({2.0f, 8.375f, 2.0f}, {14.0f, 8.625f, 14.0f}));
    scene.lights = {point_light("lamp", {8, light_height, 8}, glm::vec3(100))};
    const Shaded result = shaded(scene, grid16);
    for (size_t i = 0; i < result.surfaces.size(); ++i) {
      const glm::ivec3 v = result.surfaces.voxels[i];
      if (v.x < 3 || v.x > 12 || v.z < 3 || v.z > 12) continue;  // the rim has a side too
      REQUIRE(glm::length(result.surfaces.normal[i]) < two_sided_length);
      const float distance = glm::distance(result.surfaces.centroid[i], scene.lights[0].position);
      CHECK(result.radiance[i].r == Approx(0.5 / pi * 100.0 * 0.5 / (distance * distance)).epsilon(rounding));
    }
  }
}

TEST_CASE("a light on a surface gives a finite radiance", "[shade]") {
  Scene scene = scene_of(floor_at(2.5f, 2, 14));
  scene.lights = {point_light("lamp", {7.5f, 2.5f, 7.5f}, glm::vec3(100))};  // in the plane: no cosine anywhere
  for (const VoxelShadow shadow : {VoxelShadow::none, VoxelShadow::rays, VoxelShadow::volume})
    for (const glm::vec3& radiance : shaded(scene, grid16, shadow).radiance) CHECK(radiance == glm::vec3(0));
}

TEST_CASE("shading has the same bits on one thread and on two, and nothing to do on an empty grid", "[shade]") {
  Scene scene = scene_of(moved(scaled(icosphere(3), 20.0f), glm::vec3(24.0f)));
  scene.lights = {point_light("lamp", {24, 46, 24}, glm::vec3(100)), sun("sun", {1, 1, 0}, glm::vec3(1))};
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return shaded(scene, unit_grid(glm::ivec3(48))).radiance;
  };
  CHECK(with(1) == with(2));
  ShadeOptions options;
  options.shadow = VoxelShadow::none;
  CHECK(shade(scene, nullptr, SurfaceGrid{}, {}, options).radiance.empty());
}
