#include "reference/path.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <vector>

#include "catch.h"
#include "compare/statistics.h"
#include "parallel.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

Light point_light(const glm::vec3& position, const glm::vec3& intensity) {
  Light light;
  light.position = position;
  light.intensity = intensity;
  return light;
}

Material glossy(float roughness) {
  Material material;
  material.base_color = {0.9f, 0.7f, 0.4f, 1.0f};
  material.metallic = 0.5f;
  material.roughness = roughness;
  return material;
}

/// A room with everything in it: white walls, a glossy shelf, a lamp under the ceiling, a point light.
/// @param lamp radiance @param point intensity @param half of the lamp's side
Scene room(float lamp = 5.0f, float point = 1.0f, float half = 0.3f) {
  Scene scene;
  const uint32_t white = add_material(scene, lambert({0.7f, 0.6f, 0.5f}));
  add_cube_interior(scene, white);
  add_quad(scene, {-0.9f, -0.5f, -0.4f}, {0.0f, 0.0f, 0.8f}, {0.8f, 0.0f, 0.0f}, add_material(scene, glossy(0.4f)));
  if (lamp > 0.0f)
    add_quad(scene, {-half, 0.9f, -half}, {2.0f * half, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f * half},
             add_material(scene, lambert(glm::vec3(0.2f), glm::vec3(lamp))));
  if (point > 0.0f) scene.lights.push_back(point_light({0.5f, 0.2f, 0.3f}, glm::vec3(point, 0.5f * point, point)));
  return scene;
}

View room_view(int side) { return view_from({0.0f, 0.0f, 0.95f}, {0.0f, 0.2f, 0.0f}, side, side, 1.6f); }

const std::vector<std::string>& light_channels() {
  static const std::vector<std::string> names = {"R",          "G",          "B",          "direct.R",
                                                 "direct.G",   "direct.B",   "indirect.R", "indirect.G",
                                                 "indirect.B", "emission.R", "emission.G", "emission.B"};
  return names;
}

double mean_of(const Image& image, const std::string& channel) {
  double sum = 0.0;
  for (const float value : image.channel(channel)) sum += value;
  return sum / static_cast<double>(image.pixel_count());
}

}  // namespace

TEST_CASE("One thread and two render identical bits", "[path]") {
  const Scene scene = room();
  View view = room_view(40);  // not a multiple of a tile
  view.pixel = PixelSampling::box;
  const ThreadLimit one(1);
  const PathResult alone = render(scene, view, 20);
  const ThreadLimit two(2);
  const PathResult together = render(scene, view, 20);
  CHECK(same_bits(alone.image, together.image));
  CHECK(alone.rays == together.rays);
  CHECK(alone.mean == together.mean);
  CHECK(!same_bits(alone.image, render(scene, view, 20, std::nullopt, 1).image));  // another seed, another noise
}

TEST_CASE("Twice the light gives exactly twice the image in every layer", "[path]") {
  const PathResult once = render(room(5.0f, 1.0f), room_view(24), 16);
  const PathResult twice = render(room(10.0f, 2.0f), room_view(24), 16);
  for (const std::string& name : light_channels()) {
    size_t differing = 0;
    for (size_t i = 0; i < once.image.pixel_count(); ++i)
      differing += 2.0f * once.image.channel(name)[i] != twice.image.channel(name)[i];
    CAPTURE(name);
    CHECK(differing == 0);
  }
}

TEST_CASE("Two lights give the sum of each alone", "[path]") {
  // Of all bounces together, where a light that changes what roulette or the choice of lights does would show.
  const int spp = 1024, side = 16;
  const PathResult both = render(room(5.0f, 1.0f), room_view(side), spp);
  const PathResult lamp = render(room(5.0f, 0.0f), room_view(side), spp, std::nullopt, 1);
  // The lamp's quad stays, dark, for what it blocks and reflects.
  Scene dark = room(5.0f, 1.0f);
  dark.materials.back().emission = glm::vec3(0.0f);
  const PathResult point = render(dark, room_view(side), spp, std::nullopt, 2);
  for (int c = 0; c < 3; ++c) {
    const Welch test({both.mean[c], both.mean_stderr[c]}, {static_cast<double>(lamp.mean[c]) + point.mean[c],
                                                           std::hypot(lamp.mean_stderr[c], point.mean_stderr[c])});
    CAPTURE(test.difference, test.error);
    CHECK(test.p() > 0.001);
    CHECK(test.detectable(0.001) < 0.006 * both.mean[c]);  // the smallest difference found with probability 0.9
  }
}

TEST_CASE("The layers sum to the image and max_depth cuts them", "[path]") {
  const View view = room_view(16);
  const PathResult emission = render(room(), view, 16, 0), direct = render(room(), view, 16, 1),
                   one_bounce = render(room(), view, 16, 2), all = render(room(), view, 16);
  for (const PathResult* result : {&emission, &direct, &one_bounce, &all})
    for (const char* c : {"R", "G", "B"})
      for (size_t i = 0; i < view.width * size_t{16}; ++i) {
        const Image& image = result->image;
        const float sum = image.channel(channel_name("direct", c))[i] + image.channel(channel_name("indirect", c))[i] +
                          image.channel(channel_name("emission", c))[i];
        CHECK(image.channel(c)[i] == sum);
      }
  CHECK(mean_of(emission.image, "emission.G") > 0.0);
  CHECK(mean_of(emission.image, "direct.G") == 0.0);
  CHECK(mean_of(direct.image, "direct.G") > 0.0);
  CHECK(mean_of(direct.image, "indirect.G") == 0.0);
  CHECK(mean_of(one_bounce.image, "indirect.G") > 0.0);
  CHECK(mean_of(all.image, "indirect.G") > mean_of(one_bounce.image, "indirect.G"));
  // The same random numbers at the same vertices: what is not cut does not change.
  CHECK(mean_of(all.image, "direct.G") == mean_of(one_bounce.image, "direct.G"));
  CHECK(mean_of(all.image, "emission.G") == mean_of(emission.image, "emission.G"));
}

TEST_CASE("A noise or a time to reach ends the render", "[path]") {
  const Scene scene = room();
  const Caster caster(scene);
  PathOptions options;
  options.spp = 0;
  options.noise = 0.015;
  const PathResult quiet = path_trace(scene, caster, room_view(16), options);
  double error = 0.0, value = 0.0;
  for (size_t i = 0; i < quiet.image.pixel_count(); ++i) {
    error += quiet.image.channel("stderr.Y")[i];
    value += luminance({quiet.image.channel("R")[i], quiet.image.channel("G")[i], quiet.image.channel("B")[i]});
  }
  CHECK(error / value <= 0.015 * (1.0 + 1e-5));  // float32 channels
  CHECK(error / value > 0.009);                  // and it does not go on long after
  options.spp = 20;
  options.noise = 1e-6;
  CHECK(path_trace(scene, caster, room_view(16), options).spp == 20);
  options = {};
  options.spp = 0;
  options.seconds = 0.2;
  const PathResult timed = path_trace(scene, caster, room_view(16), options);
  CHECK(timed.seconds < 0.4);
  CHECK(timed.spp > 16);  // which take 2 ms
  options.seconds = 1e-9;
  CHECK(path_trace(scene, caster, room_view(16), options).spp == 1);  // over before it began: a single pass
}

TEST_CASE("A single pass states its error as unknown, all of the value", "[path]") {
  const PathResult result = render(room(), room_view(8), 1);
  for (size_t i = 0; i < result.image.pixel_count(); ++i)
    CHECK(result.image.channel("stderr.G")[i] == Approx(result.image.channel("G")[i]));
}

TEST_CASE("A cancelled render keeps its finished passes, or throws when there is none", "[path]") {
  const Scene scene = room();
  const Caster caster(scene);
  PathOptions options;
  options.spp = 64;  // 16 passes of 4
  std::atomic<bool> cancel = true;
  Progress progress;
  progress.cancel = &cancel;
  CHECK_THROWS_AS(path_trace(scene, caster, room_view(64), options, progress), Interrupted);
  cancel = false;
  progress.report = [&](std::string_view, double fraction) { cancel = fraction > 0.27; };
  const PathResult stopped = path_trace(scene, caster, room_view(64), options, progress);
  CHECK(stopped.interrupted);
  CHECK(stopped.spp == 16);  // 0.27 of 64 is early in the fifth pass
  CHECK(stopped.image.channel("samples")[0] == 16.0f);
}

TEST_CASE("However many samples are asked for, the first are soon there and a stop is heard at once", "[path]") {
  const Scene scene = room();
  const Caster caster(scene);
  PathOptions options;
  options.spp = 1 << 24;
  std::atomic<bool> cancel = false;
  Progress progress;
  progress.cancel = &cancel;
  using Clock = std::chrono::steady_clock;
  Clock::time_point asked;
  progress.report = [&](std::string_view, double fraction) {
    if (fraction < 1e-4 || cancel.exchange(true)) return;
    asked = Clock::now();
  };
  const PathResult stopped = path_trace(scene, caster, room_view(16), options, progress);
  // One tile: passes of 1024 samples, some milliseconds per pixel even under a sanitizer.
  CHECK(std::chrono::duration<double>(Clock::now() - asked).count() < 1.0);
  CHECK(stopped.interrupted);
  CHECK(stopped.spp == 2048);  // 1e-4 of all samples is the end of the second pass
}

TEST_CASE("Contributions that are not finite are counted, placed and left out", "[path]") {
  Scene scene = room(0.0f, 1.0f);
  scene.lights[0].intensity = glm::vec3(3e38f);  // overflows within a metre of the light
  const ThreadLimit two(2);
  const PathResult result = render(scene, room_view(16), 4, 1);
  CHECK(result.nonfinite > 0);
  CHECK(result.first_nonfinite.substr(0, 7) == "pixel (");
  for (const float value : result.image.channel("G")) CHECK(std::isfinite(value));
  const ThreadLimit one(1);
  const PathResult again = render(scene, room_view(16), 4, 1);
  CHECK(again.nonfinite == result.nonfinite);
  CHECK(again.first_nonfinite == result.first_nonfinite);
  CHECK(render(room(), room_view(16), 4).nonfinite == 0);
}

TEST_CASE("What is not finite in the irradiance alone is counted too", "[path]") {
  // The floor that is seen is black, and ends its paths. Were it white, they would go on to a ceiling so close to the
  // light that its irradiance overflows.
  Scene scene;
  add_floor(scene, 2.0f, add_material(scene, lambert(glm::vec3(0.0f))));
  add_quad(scene, {-2.0f, 1.0f, -2.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 4.0f},
           add_material(scene, lambert(glm::vec3(0.5f))));
  scene.lights.push_back(point_light({0.0f, 0.99f, 0.0f}, glm::vec3(1e37f)));
  const Caster caster(scene);
  PathOptions options;
  options.spp = 64;
  const View view = view_from({0.0f, 0.5f, 0.0f}, {0.0f, 0.0f, 0.0f}, 16, 16);
  REQUIRE(path_trace(scene, caster, view, options).nonfinite == 0);
  options.extra.irradiance = true;
  const PathResult result = path_trace(scene, caster, view, options);
  CHECK(result.nonfinite > 0);
  CHECK(result.first_nonfinite.substr(0, 7) == "pixel (");
}

TEST_CASE("A scene without triangles renders its background", "[path]") {
  View view = room_view(4);
  view.background = {0.25f, 0.5f, 1.0f};
  const PathResult result = render(Scene{}, view, 2);
  CHECK(result.mean == view.background);
  CHECK(result.image.channel("Z")[0] == 0.0f);
  CHECK(result.image.channel("emission.B")[3] == 1.0f);
}

TEST_CASE("What the camera sees is the mean over the samples that hit", "[path]") {
  Scene scene;
  add_quad(scene, {-10.0f, -10.0f, -2.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 20.0f, 0.0f},
           add_material(scene, lambert({0.25f, 0.5f, 0.75f})));
  View view = view_from(glm::vec3(0.0f), {0.0f, 0.0f, -1.0f}, 3, 3);  // the quad's edge cuts the middle column
  view.pixel = PixelSampling::box;
  const Image image = render(scene, view, 16).image;
  for (const size_t pixel : {0, 1}) {
    CHECK(image.channel("albedo.G")[pixel] == Approx(0.5f));
    CHECK(image.channel("N.Z")[pixel] == Approx(1.0f));
    CHECK(image.channel("Z")[pixel] == Approx(2.0f));
  }
  CHECK(image.channel("Z")[2] == 0.0f);
}

TEST_CASE("Options out of range are refused by name", "[path]") {
  const Scene scene = room();
  const Caster caster(scene);
  const auto refused = [&](const PathOptions& options) {
    try {
      path_trace(scene, caster, room_view(2), options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  PathOptions options;
  options.spp = 0;
  CHECK(refused(options).substr(0, 4) == "spp:");
  options = {};
  options.noise = 0.0;
  CHECK(refused(options).substr(0, 6) == "noise:");
  options = {};
  options.seconds = -1.0;
  CHECK(refused(options).substr(0, 5) == "time:");
  options = {};
  options.max_depth = -1;
  CHECK(refused(options).substr(0, 10) == "max-depth:");
}

}  // namespace voxref
