#include "study/ray_gather.h"

#include <glm/common.hpp>
#include <numbers>
#include <random>

#include "catch.h"
#include "closed_form/polygon.h"
#include "compare/statistics.h"
#include "reference/small_scenes.h"
#include "voxel/shade.h"

using namespace voxref;

namespace {

SurfaceGrid voxels_of(const Scene& scene, int resolution) {
  GridOptions grid;
  grid.resolution = resolution;
  return voxelize(scene, fit_grid(scene.bounds(), grid), {});
}

/// A value that is another in every voxel, and never 0.
std::vector<glm::vec3> numbers(const SurfaceGrid& surfaces) {
  std::vector<glm::vec3> values;
  for (size_t i = 0; i < surfaces.size(); ++i) values.emplace_back(float(i + 1), 0.0f, 1.0f);
  return values;
}

glm::vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

/// Least squared distance of a position, in voxels, to a voxel's box.
float distance2(const glm::vec3& p, const glm::ivec3& voxel) {
  const glm::vec3 away = p - glm::clamp(p, glm::vec3(voxel), glm::vec3(voxel + 1));
  return glm::dot(away, away);
}

/// A square of side 1 at height 1 over the origin.
constexpr std::array<glm::dvec3, 4> square = {{{-0.5, 1.0, -0.5}, {0.5, 1.0, -0.5}, {0.5, 1.0, 0.5}, {-0.5, 1.0, 0.5}}};

}  // namespace

TEST_CASE("A seen point is what the pixel's ray hits, and near contacts are known", "[ladder]") {
  Scene scene;
  const uint32_t grey = add_material(scene, lambert(glm::vec3(0.5f)));
  add_floor(scene, 2.0f, grey);
  add_quad(scene, {-2.0f, 0.0f, -2.0f}, {0.0f, 4.0f, 0.0f}, {0.0f, 0.0f, 4.0f}, grey);  // a wall at x = -2
  const Caster caster(scene);
  constexpr float voxel = 0.1f;
  // From straight above, 16 pixels across the floor's whole width and more: x = -2.4 ... 2.4.
  View view = view_from({0.0f, 10.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 16, 1);
  view.camera.orthographic = true;
  view.camera.ymag = 2.4f / 16.0f;
  const std::vector<SeenPoint> seen = see(scene, caster, view, {}, voxel);
  REQUIRE(seen.size() == 16);
  for (size_t i = 0; i < seen.size(); ++i) {
    const float x = -2.4f + 4.8f * (float(i) + 0.5f) / 16.0f;
    CAPTURE(i, x);
    CHECK(seen[i].surface == (std::abs(x) < 2.0f));
    if (!seen[i].surface) continue;
    CHECK(glm::length(seen[i].point.position - glm::vec3(x, 0.0f, 0.0f)) < 1e-4f);  // float32 at a distance of 10
    CHECK(glm::length(seen[i].point.geometric_normal - glm::vec3(0.0f, 1.0f, 0.0f)) < 1e-6f);
    CHECK(glm::length(seen[i].to_viewer - glm::vec3(0.0f, 1.0f, 0.0f)) < 1e-6f);
    // Its rays rise by a fifth of their way; three voxels reach 0.29 to the side.
    CHECK(seen[i].contact == (x + 2.0f < 0.29f));
    CHECK((seen[i].point.aside.x > 0.0f) == (x + 2.0f < 0.15f));  // the apex stands off by 1.5 voxels
  }
}

TEST_CASE("Rays that a pixel gathers with find Lambert's irradiance, and a specular lobe apart", "[ladder]") {
  Scene scene;
  constexpr float albedo = 0.6f;
  add_floor(scene, 2.0f, add_material(scene, lambert(glm::vec3(albedo))));
  Material glossy;
  glossy.metallic = 0.5f;
  glossy.roughness = 0.3f;
  add_quad(scene, {4.0f, 0.0f, 1.0f}, {0.0f, 0.0f, -2.0f}, {-1.5f, 0.0f, 0.0f}, add_material(scene, glossy));
  const Caster caster(scene);
  const View view = view_from({1.0f, 3.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 9, 5, 1.2f);
  const std::vector<SeenPoint> seen = see(scene, caster, view, {}, 0.01f);

  const IncomingRadiance from_square = [](const GatherPoint& from, const glm::vec3& direction) {
    const float t = (1.0f - from.position.y) / direction.y;
    const glm::vec3 p = from.position + t * direction;
    return glm::vec3(t > 0.0f && std::abs(p.x) < 0.5f && std::abs(p.z) < 0.5f ? 1.0f : 0.0f);
  };
  constexpr int seeds = 16, rays = 1024;
  std::vector<std::vector<double>> found(seen.size());
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::vector<glm::vec3> light = gather_rays(seen, view, rays, seed, from_square, {});
    for (size_t i = 0; i < seen.size(); ++i) found[i].push_back(double(light[i].g));
  }
  // Without its lobe the glossy quad reflects what its base and nothing else reflects, and so less.
  const std::vector<glm::vec3> all = gather_rays(seen, view, rays, 1, [](auto&&...) { return glm::vec3(1.0f); }, {}),
                               dull = gather_rays(without_specular(seen), view, rays, 1,
                                                  [](auto&&...) { return glm::vec3(1.0f); }, {});
  size_t lambertian = 0, lobes = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].surface) continue;
    const Reflectance& reflectance = seen[i].shading.reflectance;
    if (reflectance.has_specular()) {
      ++lobes;
      const float cosine = glm::dot(seen[i].shading.shading_normal, seen[i].to_viewer);
      // Tabulated albedos err by 0.002, each; 1024 samples of at most 1 by less than 1 / sqrt(1024) = 0.03.
      CHECK(dull[i].g == Approx(diffuse_albedo(reflectance, cosine).g).margin(0.02));
      CHECK(all[i].g - dull[i].g == Approx(specular_albedo(reflectance, cosine).g).margin(0.04));
      continue;
    }
    ++lambertian;
    CHECK(dull[i].g == Approx(albedo).epsilon(1e-5));
    const double truth =
        albedo * std::numbers::inv_pi * polygon_irradiance(square, glm::dvec3(seen[i].point.position), {0.0, 1.0, 0.0});
    const Estimate mean = estimate(found[i]);
    CAPTURE(i, truth, mean.mean, mean.error);
    CHECK(mean.error < 0.0005);  // of up to 0.14
    // 35 pixels with 15 degrees of freedom: one in 1000 images of another seed would fail.
    CHECK(student_tail((mean.mean - truth) / mean.error, mean.freedom) > 3e-5);
  }
  CHECK(lambertian > 20);
  CHECK(lobes > 5);
}

TEST_CASE("Rays look up the voxel that holds what they hit, else the nearest that is occupied", "[ladder]") {
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert(glm::vec3(0.5f))));
  // Walls at x = 0.6 lie on voxel faces or between, whatever rounding says; a sheet that no axis is parallel to as
  // well.
  add_quad(scene, {-0.5f, -0.6f, -0.4f}, {0.9f, 0.2f, 0.1f}, {0.1f, 0.7f, 0.6f}, 0);
  const Caster caster(scene);
  const SurfaceGrid surfaces = voxels_of(scene, 16);
  const BrickVolume<glm::vec4> volume = voxel_volume(surfaces, numbers(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i) REQUIRE(volume(surfaces.voxels[i]) == glm::vec4(float(i + 1), 0, 1, 1));
  const VoxelRadiance incoming(caster, surfaces.grid, volume, glm::vec3(7.0f));
  std::mt19937 random(1);
  for (int k = 0; k < 2000; ++k) {
    const GatherPoint from{glm::vec3(0.0f, -0.9f, 0.0f) + 0.05f * random_direction(random), {0.0f, 1.0f, 0.0f}, {}, {}};
    glm::vec3 direction = random_direction(random);
    direction.y = std::abs(direction.y);
    const Ray ray = caster.leave(from.position, from.geometric_normal, direction);
    const Hit hit = caster.closest(ray);
    REQUIRE(hit);
    const glm::vec3 p = surfaces.grid.to_voxels(ray.origin + hit.t * direction);
    float least = std::numeric_limits<float>::infinity();
    for (const glm::ivec3& voxel : surfaces.voxels) least = std::min(least, distance2(p, voxel));
    const glm::vec3 found = incoming(from, direction);
    const auto index = static_cast<size_t>(std::lround(found.x)) - 1;
    REQUIRE(index < surfaces.size());
    CHECK(found == glm::vec3(float(index + 1), 0.0f, 1.0f));
    CHECK(distance2(p, surfaces.voxels[index]) == least);
  }
  // Scaled as a medium's texels are, by any factor, they hold the same radiance.
  BrickVolume<glm::vec4> thick = volume;
  for (glm::vec4& texel : thick.texels()) texel *= 9.0f;
  const GatherPoint middle{{0.0f, -0.9f, 0.0f}, {0.0f, 1.0f, 0.0f}, {}, {}};
  const glm::vec3 up = glm::normalize(glm::vec3(0.3f, 1.0f, 0.2f));
  CHECK(glm::length(VoxelRadiance(caster, surfaces.grid, thick, glm::vec3(7.0f))(middle, up) - incoming(middle, up)) <
        1e-3f);
  // Outside the cube, away from it: nothing but the surroundings.
  CHECK(incoming({{0.0f, 2.0f, 0.0f}, up, up, {}}, up) == glm::vec3(7.0f));
}

TEST_CASE("Bounces by rays in a closed furnace are the geometric series, for any number of rays", "[ladder]") {
  constexpr float albedo = 0.5f;
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert(glm::vec3(albedo), glm::vec3(1.0f))));
  const Caster caster(scene);
  const SurfaceGrid surfaces = voxels_of(scene, 16);
  const std::vector<glm::vec3> direct(surfaces.size(), glm::vec3(1.0f));
  for (const int count : {0, 1, 4}) {
    const double truth = (1.0 - std::pow(albedo, count + 1)) / (1.0 - albedo);
    for (const glm::vec3& radiance : bounce_by_rays(surfaces, direct, caster, glm::vec3(0.0f), count, 2, 1, {}))
      CHECK(radiance.g == Approx(truth).epsilon(1e-5));
  }
}

TEST_CASE("Bounces by rays carry what form factors say, to both sides of a sheet, and tries are independent",
          "[ladder]") {
  // A floor of side 1 that emits 3 upwards, a reflecting sheet above it, surroundings of 1.
  Scene scene;
  add_floor(scene, 0.5f, add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(3.0f))));
  const uint32_t white = add_material(scene, lambert(glm::vec3(0.8f)));
  add_quad(scene, {-0.1f, 1.0f, -0.1f}, {0.0f, 0.0f, 0.2f}, {0.2f, 0.0f, 0.0f}, white);
  SECTION("its front up") {}
  SECTION("both sides") { add_quad(scene, {-0.1f, 1.0f, -0.1f}, {0.2f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.2f}, white); }
  const bool both = scene.objects.size() == 3;
  const Caster caster(scene);
  const SurfaceGrid surfaces = voxels_of(scene, 24);
  const Shading shading = shade(scene, &caster, surfaces, {}, {});
  size_t center = surfaces.size();  // the voxel of the sheet nearest its middle
  const glm::vec3 middle(0.0f, 1.0f, 0.0f);
  for (size_t i = 0; i < surfaces.size(); ++i)
    if (center == surfaces.size() ||
        glm::length(surfaces.centroid[i] - middle) < glm::length(surfaces.centroid[center] - middle))
      center = i;
  // Rays start half a voxel off the sheet. Upwards nothing is met.
  std::array<glm::dvec3, 4> floor = square;
  for (glm::dvec3& corner : floor) corner.y = 0.0;
  const glm::dvec3 below = glm::dvec3(surfaces.centroid[center]) - glm::dvec3(0.0, 0.5 * surfaces.grid.voxel, 0.0);
  const double seen = polygon_irradiance(floor, below, {0.0, 1.0, 0.0}) * std::numbers::inv_pi;
  const double truth = 0.8 * (both ? 0.5 * (1.0 + 3.0 * seen + (1.0 - seen)) : 1.0);
  std::vector<double> found;
  constexpr int tries = 16;
  for (uint64_t seed = 1; seed <= tries; ++seed)
    found.push_back(
        double(bounce_by_rays(surfaces, shading.radiance, caster, glm::vec3(1.0f), 1, 1024, seed, {})[center].g));
  const Estimate mean = estimate(found);
  CAPTURE(both, truth, mean.mean, mean.error);
  CHECK(mean.mean == Approx(truth).epsilon(0.01));  // 16384 rays, of which a tenth meets the floor
  if (!both) return;
  CHECK(mean.error > 0.0);  // another try, other rays
  CHECK(mean.error < 0.005 * truth);
  CHECK(std::abs(mean.mean - truth) < 4.0 * mean.error);
}
