#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "catch.h"
#include "cone/bounce.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "reference/small_scenes.h"
#include "voxel/shade.h"

// What the whole cone tracer must not depend on, on three scenes: a room with blocks, one cut by thin sheets, and a
// curved one.

namespace voxref {
namespace {

std::vector<std::pair<const char*, Scene>> three_scenes() {
  return {{"Cornell box", cornell_box(CornellLight::point)},
          {"red and green wall", red_green_wall()},
          {"sphere", sphere_furnace(0.5f, 2)}};
}

Image traced(const Scene& scene, float step = 0.5f, ConeOpacity opacity = ConeOpacity::extinction) {
  const Caster caster(scene);
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = 16;
  Settings settings = profile("radiometric");
  settings.grid.resolution = 32;
  settings.render.cone.step = step;
  settings.render.cone.opacity = opacity;
  settings.bounce.count = 1;
  return cone_trace(scene, caster, view, settings).image.image;
}

/// Of the light that the diffuse cones gathered.
double mean_difference(const Image& a, const Image& b) {
  double difference = 0.0, sum = 0.0;
  for (const char* channel : {"diffuse.R", "diffuse.G", "diffuse.B"})
    for (size_t i = 0; i < a.pixel_count(); ++i) {
      difference += std::abs(double(a.channel(channel)[i]) - double(b.channel(channel)[i]));
      sum += b.channel(channel)[i];
    }
  return difference / sum;
}

/// Rooms of side 2 for 35 voxels: voxels of 1/16, and all coordinates multiples of 1/32.
std::vector<std::pair<const char*, Scene>> dyadic_rooms() {
  Scene empty;
  add_cube_interior(empty, add_material(empty, lambert({0.75f, 0.5f, 0.25f})));
  Light light;
  light.position = {0.375f, 0.5f, -0.25f};
  empty.lights.push_back(light);
  Scene shelf = empty;
  add_quad(shelf, {-0.5f, -0.25f, -0.5f}, {0.0f, 0.0f, 0.75f}, {0.75f, 0.0f, 0.0f},
           add_material(shelf, lambert({0.25f, 0.5f, 1.0f})));
  Scene lamp = shelf;
  lamp.lights.clear();
  add_quad(lamp, {-0.25f, 0.75f, -0.25f}, {0.5f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.5f},
           add_material(lamp, lambert(glm::vec3(0.25f), {4.0f, 2.0f, 1.0f})));
  return {{"empty", empty}, {"shelf", shelf}, {"shelf and lamp", lamp}};
}

}  // namespace

TEST_CASE("Twice the light gives twice the image, to the bit, on three scenes", "[consistency]") {
  for (auto [name, scene] : three_scenes()) {
    const Image once = traced(scene);
    for (Light& light : scene.lights) light.intensity *= 2.0f;
    const Image twice = traced(scene);
    size_t different = 0;
    for (const char* channel : {"R", "G", "B"})
      for (size_t i = 0; i < once.pixel_count(); ++i)
        different += twice.channel(channel)[i] != 2.0f * once.channel(channel)[i];
    CAPTURE(name);
    CHECK(different == 0);
  }
}

TEST_CASE("The images of two lights add up to the image of both, on three scenes", "[consistency]") {
  for (auto [name, scene] : three_scenes()) {
    Light first = scene.lights.at(0), second = first;
    second.position += 0.05f * glm::vec3(1.0f, -1.0f, 1.0f);
    second.intensity = glm::vec3(0.3f, 0.1f, 0.5f);
    scene.lights = {first};
    const Image a = traced(scene);
    scene.lights = {second};
    const Image b = traced(scene);
    scene.lights = {first, second};
    const Image both = traced(scene);
    CAPTURE(name);
    for (const char* channel : {"R", "G", "B"})
      for (size_t i = 0; i < both.pixel_count(); ++i)
        // Rounding of the sums over cones, steps and texels.
        CHECK(both.channel(channel)[i] ==
              Approx(a.channel(channel)[i] + b.channel(channel)[i]).epsilon(1e-4).margin(1e-6));
  }
}

TEST_CASE("The step hardly shows where extinction is interpolated, and much where opacity is, on three scenes",
          "[consistency]") {
  for (const auto& [name, scene] : three_scenes()) {
    const auto drift = [&](float step, ConeOpacity opacity) {
      return mean_difference(traced(scene, step, opacity), traced(scene, 0.1f, opacity));
    };
    const double half = drift(0.5f, ConeOpacity::extinction), quarter = drift(0.25f, ConeOpacity::extinction);
    const double raw_half = drift(0.5f, ConeOpacity::raw), raw_quarter = drift(0.25f, ConeOpacity::raw);
    fmt::print("steps 0.5 and 0.25 against 0.1, {}: extinction {:.2f} % and {:.2f} %, raw {:.1f} % and {:.1f} %\n",
               name, 100.0 * half, 100.0 * quarter, 100.0 * raw_half, 100.0 * raw_quarter);
    CAPTURE(name, half, quarter, raw_half, raw_quarter);
    CHECK(half < 0.03);
    CHECK(quarter < 0.03);
    CHECK(raw_half > 5.0 * half);
  }
}

TEST_CASE("Moved by whole voxels, dyadic surfaces bounce to the same bits, in three rooms", "[consistency]") {
  const auto bounced = [](const Scene& scene) {
    const Caster caster(scene);
    const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), {35}), {});
    REQUIRE(surfaces.grid.voxel == 0.0625f);
    BounceOptions options;
    options.count = 2;
    return bounce(surfaces, shade(scene, &caster, surfaces, {}, {}).radiance, options, {}, {}, glm::vec3(0.0f))
        .radiance;
  };
  for (const auto& [name, room] : dyadic_rooms()) {
    const std::vector<glm::vec3> here = bounced(room);
    for (const glm::vec3 voxels : {glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(-3.0f, 5.0f, 16.0f)}) {
      Scene moved = room;
      for (glm::vec3& position : moved.positions) position += voxels / 16.0f;
      for (Light& light : moved.lights) light.position += voxels / 16.0f;
      const std::vector<glm::vec3> there = bounced(moved);
      REQUIRE(there.size() == here.size());
      size_t different = 0;
      float largest = 0.0f;
      for (size_t i = 0; i < here.size(); ++i) {
        different += there[i] != here[i];
        largest = std::max(largest, glm::length(there[i] - here[i]) / glm::length(here[i]));
      }
      CAPTURE(name, different, largest);
      // The centroids of the eight corner voxels are thirds of a voxel, which no float holds: theirs is the last digit.
      CHECK(different <= 8);
      CHECK(largest < 1e-6f);
    }
  }
}

}  // namespace voxref
