// Shading with the options of the villegas2016 profile, each quirk on its own.
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "catch.h"
#include "settings.h"
#include "voxel/mesh_scene.h"
#include "voxel/shade.h"

using namespace voxref;

namespace {

const Settings published = profile("villegas2016");

/// One voxel of a grid of 16 unit voxels, albedo 1.
SurfaceGrid voxel(const glm::ivec3& at, const glm::vec3& normal) {
  SurfaceGrid surfaces;
  surfaces.grid = unit_grid(glm::ivec3(16));
  surfaces.voxels = {at};
  surfaces.albedo = {glm::vec4(1.0f)};
  surfaces.normal = {normal};
  surfaces.centroid = {surfaces.grid.center(at)};
  return surfaces;
}

Scene lit_by(const Light& light) {
  Scene scene;
  scene.lights = {light};
  return scene;
}

ShadeOptions without_shadow() {
  ShadeOptions options = published.shade;
  options.shadow = VoxelShadow::none;
  return options;
}

float red(const Scene& scene, const SurfaceGrid& surfaces, const ShadeOptions& options,
          const LightOptions& light = published.light) {
  return shade(scene, nullptr, surfaces, light, options).radiance[0].r;
}

/// A wall that fills the layer y of the grid, seen by a voxel at (8, 2, 8) that faces up.
SurfaceGrid under_wall(int y) {
  SurfaceGrid surfaces = voxel({8, 2, 8}, {0, 1, 0});
  for (int z = 0; z < 16; ++z)
    for (int x = 0; x < 16; ++x) {
      surfaces.voxels.emplace_back(x, y, z);
      surfaces.albedo.emplace_back(1.0f);
      surfaces.normal.emplace_back(0.0f, 1.0f, 0.0f);
      surfaces.centroid.push_back(surfaces.grid.center(surfaces.voxels.back()));
    }
  return surfaces;
}

}  // namespace

TEST_CASE("Light arrives at the voxel's corner, half a voxel along the normal", "[shade]") {
  // With l = 1 as the only coefficient the falloff 1 / (1 + d) tells the distance.
  const LightOptions linear{LightFalloff::attenuated, {0.0f, 1.0f, 0.0f}};
  const Scene scene = lit_by(point_light("lamp", {4.0f, 13.5f, 6.0f}, glm::vec3(1.0f)));
  const SurfaceGrid surfaces = voxel({4, 3, 6}, {0, 1, 0});
  ShadeOptions options = without_shadow();
  CHECK(red(scene, surfaces, options, linear) == Approx(1.0 / (1.0 + 10.0)));  // from (4, 3.5, 6)
  options.position = ShadePosition::centroid;                                  // (4.5, 3.5, 6.5)
  const double d = std::sqrt(100.5), cosine = 10.0 / d;
  options.normal_weighted = false;
  CHECK(red(scene, surfaces, options, linear) == Approx(cosine / (1.0 + d)));
}

TEST_CASE("Falloff is 1 / (1 + c + l d + q d^2) and has no effect on directional lights", "[shade]") {
  const LightOptions light{LightFalloff::attenuated, {0.5f, 0.25f, 0.125f}};
  const SurfaceGrid surfaces = voxel({4, 3, 6}, {0, 1, 0});
  const Scene point = lit_by(point_light("lamp", {4.0f, 7.5f, 6.0f}, glm::vec3(1.0f)));
  CHECK(red(point, surfaces, without_shadow(), light) == Approx(1.0 / (1.0 + 0.5 + 1.0 + 2.0)));
  CHECK(red(lit_by(sun("sun", {0, -1, 0}, glm::vec3(1.0f))), surfaces, without_shadow(), light) == 1.0f);
}

TEST_CASE("Directional lights are summed before point lights, wherever the file has them", "[shade]") {
  Scene scene = lit_by(point_light("faint", {4.0f, 7.5f, 6.0f}, glm::vec3(5e-8f)));
  scene.lights.push_back(scene.lights[0]);
  Light sun;
  sun.type = LightType::directional;
  sun.direction = {0, -1, 0};
  scene.lights.push_back(sun);
  // 1 + 5e-8 is 1 in float32, and once more; 1e-7 + 1 is not.
  CHECK(red(scene, voxel({4, 3, 6}, {0, 1, 0}), without_shadow()) == 1.0f);
}

TEST_CASE("A spot light fades by smoothstep between its cones", "[shade]") {
  Light spot = point_light("spot", {4.0f, 7.5f, 6.0f}, glm::vec3(1.0f));
  spot.type = LightType::spot;
  const SurfaceGrid surfaces = voxel({4, 3, 6}, {0, 1, 0});
  // cos = 1 at the voxel straight below; the ramp (1 - outer) / (inner - outer) is moved instead of the voxel.
  spot.direction = {0, -1, 0};
  spot.cos_outer = 0.5f;
  for (const double ramp : {0.25, 0.5, 0.75}) {
    spot.cos_inner = float(0.5 + 0.5 / ramp);
    CHECK(red(lit_by(spot), surfaces, without_shadow()) == Approx(ramp * ramp * (3.0 - 2.0 * ramp)));
  }
  spot.direction = glm::normalize(glm::vec3(1, -0.5f, 0));  // cos 0.447: outside
  spot.cos_inner = 0.9f;
  CHECK(red(lit_by(spot), surfaces, without_shadow()) == 0.0f);
}

TEST_CASE("The normal-weighted attenuation is between 0.57 and 1 of Lambert's cosine at l = n", "[shade]") {
  // sum n_a^2 |n_a|: 1 along an axis, 3 (1/3)^1.5 = 0.577 along a diagonal.
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  double least = 2.0, greatest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 n = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    const float value = red(lit_by(sun("sun", -n, glm::vec3(1.0f))), voxel({4, 3, 6}, n), without_shadow());
    least = std::min(least, double(value)), greatest = std::max(greatest, double(value));
  }
  CHECK(least >= std::sqrt(1.0 / 3.0) - 1e-6);
  CHECK(least < 0.6);
  CHECK(greatest <= 1.0 + 1e-6);
  CHECK(greatest > 0.95);
}

TEST_CASE("The normal-weighted attenuation counts each axis for itself", "[shade]") {
  const glm::vec3 n(0.6f, 0.0f, -0.8f);
  const auto value = [&](const glm::vec3& l) {
    return red(lit_by(sun("sun", -l, glm::vec3(1.0f))), voxel({4, 3, 6}, n), without_shadow());
  };
  CHECK(value({1, 0, 0}) == Approx(0.36));
  CHECK(value({0, 0, -1}) == Approx(0.64));
  CHECK(value({-1, 0, 0}) == 0.0f);
  // Where Lambert's cosine is negative, -0.28, one axis is lit all the same.
  CHECK(value({0.6f, 0.0f, 0.8f}) == Approx(0.36 * 0.6));
  ShadeOptions lambert = without_shadow();
  lambert.normal_weighted = false;
  CHECK(red(lit_by(sun("sun", {-0.6f, 0.0f, -0.8f}, glm::vec3(1.0f))), voxel({4, 3, 6}, n), lambert) == 0.0f);
}

TEST_CASE("Without normalization radiance is albedo times light, with it a part in pi", "[shade]") {
  const Scene scene = lit_by(sun("sun", {0, -1, 0}, glm::vec3(2.0f)));
  ShadeOptions options = without_shadow();
  CHECK(red(scene, voxel({4, 3, 6}, {0, 1, 0}), options) == 2.0f);
  options.normalization = ShadeNormalization::lambert;
  CHECK(red(scene, voxel({4, 3, 6}, {0, 1, 0}), options) == Approx(2.0 / 3.14159265358979));
}

TEST_CASE("A short mean normal is taken at its full length unless two-sided voxels are asked for", "[shade]") {
  const Scene scene = lit_by(sun("sun", {0, 1, 0}, glm::vec3(1.0f)));  // from below
  ShadeOptions options = without_shadow();
  CHECK(red(scene, voxel({4, 3, 6}, {0, 0.1f, 0}), options) == 0.0f);
  CHECK(red(scene, voxel({4, 3, 6}, {0, -0.1f, 0}), options) == 1.0f);
  options.two_sided = true;
  CHECK(red(scene, voxel({4, 3, 6}, {0, 0.1f, 0}), options) == 0.5f);
}

TEST_CASE("A point light's negative visibility is none; a directional light's takes light away", "[shade]") {
  SurfaceGrid surfaces = under_wall(4);  // 2 voxels above the start: k / t = 0.25 / (2 / 16) = 2
  surfaces.emission.assign(surfaces.size(), glm::vec3(3.0f));
  const Shading point = shade(lit_by(point_light("lamp", {8, 14, 8}, glm::vec3(1.0f))), nullptr, surfaces,
                              published.light, published.shade);
  CHECK(point.radiance[0].r == 3.0f);
  CHECK(point.visibility[0] == 0.0f);
  const Shading directional =
      shade(lit_by(sun("sun", {0, -1, 0}, glm::vec3(1.0f))), nullptr, surfaces, published.light, published.shade);
  CHECK(directional.radiance[0].r == Approx(3.0 - 1.0));  // visibility 1 - 2
  CHECK(directional.visibility[0] == 0.0f);
}

TEST_CASE("Visibility is the mean over the lights; a light outside its spot or blocked counts as none", "[shade]") {
  SurfaceGrid surfaces = voxel({8, 2, 8}, {0, 1, 0});
  Scene scene = lit_by(sun("sun", {0, -1, 0}, glm::vec3(1.0f)));
  const auto visibility = [&] {
    return shade(scene, nullptr, surfaces, published.light, published.shade).visibility[0];
  };
  CHECK(visibility() == 1.0f);
  scene.lights.push_back(sun("behind", {0, 1, 0}, glm::vec3(1.0f)));  // lights nothing, but is seen
  CHECK(visibility() == 1.0f);
  Light spot = point_light("spot", {8, 14, 8}, glm::vec3(1.0f));
  spot.type = LightType::spot;
  spot.direction = {1, 0, 0};
  scene.lights.push_back(spot);
  CHECK(visibility() == Approx(2.0 / 3.0));
  scene.lights = {};
  CHECK(visibility() == 0.0f);
}

TEST_CASE("A black voxel gets no direct light and no visibility, but emits", "[shade]") {
  SurfaceGrid surfaces = voxel({8, 2, 8}, {0, 1, 0});
  surfaces.albedo[0] = {0.0f, 0.0f, 0.0f, 1.0f};
  surfaces.emission = {glm::vec3(0.25f)};
  const Shading shading =
      shade(lit_by(sun("sun", {0, -1, 0}, glm::vec3(1.0f))), nullptr, surfaces, published.light, published.shade);
  CHECK(shading.radiance[0] == glm::vec3(0.25f));
  CHECK(shading.visibility[0] == 0.0f);
}

TEST_CASE("A voxel whose count wrapped to 0 stays dark", "[shade]") {
  SurfaceGrid surfaces = voxel({8, 2, 8}, {0, 1, 0});
  surfaces.albedo[0].a = 0.0f;
  surfaces.emission = {glm::vec3(0.25f)};
  CHECK(red(lit_by(sun("sun", {0, -1, 0}, glm::vec3(1.0f))), surfaces, published.shade) == 0.0f);
}
