// Static and dynamic objects: stepping through frames against building each frame from nothing, in both profiles.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "catch.h"
#include "parallel.h"
#include "settings.h"
#include "voxel/mesh_scene.h"
#include "voxel/voxelize.h"

using namespace voxref;

namespace {

const Grid grid = unit_grid(glm::ivec3(24));

/// A room's floor and back wall, and a box that moves across both.
Scene frame(int index) {
  Scene scene;
  const uint32_t grey = add_material(scene, lambertian("grey", glm::vec3(0.3f)));
  const uint32_t glow = add_material(scene, emitter("glow", glm::vec3(0.8f, 0.2f, 0.1f), glm::vec3(0.5f)));
  add_object(scene, "floor", quad({2, 3.3f, 2}, {2, 3.3f, 22}, {22, 3.3f, 22}, {22, 3.3f, 2}), grey);
  const float x = 4.0f + 1.37f * float(index);
  add_object(scene, "mover", box({x, 2.6f, 5.1f}, {x + 4.2f, 7.7f, 9.9f}), glow);
  scene.objects.back().dynamic = true;
  add_object(scene, "wall", quad({2, 2, 3.4f}, {22, 2, 3.4f}, {22, 22, 3.4f}, {2, 22, 3.4f}), grey);
  return scene;
}

bool same(const SurfaceGrid& a, const SurfaceGrid& b) {
  return a.voxels == b.voxels && a.area == b.area && a.fragments == b.fragments && a.dynamic == b.dynamic &&
         a.albedo == b.albedo && a.normal == b.normal && a.centroid == b.centroid && a.emission == b.emission;
}

}  // namespace

TEST_CASE("Stepping through frames gives the voxels of building each frame from nothing", "[voxelize]") {
  VoxelizeOptions plain_mean = profile("villegas2016").voxelize;
  plain_mean.average = VoxelAverage::area;
  for (VoxelizeOptions options : {profile("radiometric").voxelize, profile("villegas2016").voxelize, plain_mean}) {
    for (const bool static_wins : {true, false}) {
      options.static_wins = static_wins;
      CAPTURE(int(options.method), int(options.average), static_wins);
      const SurfaceGrid fixed = voxelize_static(frame(0), grid, options);
      for (int k = 0; k < 6; ++k) {
        CAPTURE(k);
        CHECK(same(add_dynamic(frame(k), fixed, options), voxelize(frame(k), grid, options)));
      }
      CHECK_FALSE(same(voxelize(frame(0), grid, options), voxelize(frame(3), grid, options)));
    }
  }
}

TEST_CASE("Static and dynamic pieces merge by area as if they were one object", "[voxelize]") {
  const VoxelizeOptions options = profile("radiometric").voxelize;
  Scene scene = frame(2);
  const SurfaceGrid merged = voxelize(scene, grid, options);
  scene.objects[1].dynamic = false;
  const SurfaceGrid whole = voxelize(scene, grid, options);
  REQUIRE(merged.voxels == whole.voxels);
  double worst = 0.0;
  for (size_t i = 0; i < whole.size(); ++i) {
    const glm::vec4 albedo = glm::abs(merged.albedo[i] - whole.albedo[i]);
    const glm::vec3 others = glm::abs(merged.normal[i] - whole.normal[i]) +
                             glm::abs(merged.emission[i] - whole.emission[i]) +
                             glm::abs(merged.centroid[i] - whole.centroid[i]) / 24.0f;
    worst = std::max({worst, double(albedo.r), double(albedo.a), double(others.x), double(others.y), double(others.z),
                      std::abs(double(merged.area[i] - whole.area[i]))});
  }
  CHECK(worst < 1e-6);  // some roundings of float32
}

TEST_CASE("Dynamic voxels are those without anything static", "[voxelize]") {
  const Scene scene = frame(1);
  for (const char* name : {"radiometric", "villegas2016"}) {
    const VoxelizeOptions options = profile(name).voxelize;
    const SurfaceGrid fixed = voxelize_static(scene, grid, options), all = voxelize(scene, grid, options);
    CAPTURE(name);
    REQUIRE(all.dynamic.size() == all.size());
    CHECK(fixed.dynamic.empty());
    size_t moving = 0, wrong = 0;
    for (size_t i = 0; i < all.size(); ++i) {
      const bool is_static = std::find(fixed.voxels.begin(), fixed.voxels.end(), all.voxels[i]) != fixed.voxels.end();
      wrong += is_static == (all.dynamic[i] != 0);
      moving += all.dynamic[i];
    }
    CHECK(wrong == 0);
    CHECK(moving > 50);
  }
}
