#include "study/ladder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.h"
#include "closed_form/polygon.h"
#include "make_scenes/builders.h"
#include "reference/small_scenes.h"
#include "study/ladder_setup.h"
#include "study/ray_gather.h"
#include "study/study_scenes.h"

using namespace voxref;

TEST_CASE("A step between rungs is their paired difference, its noise taken out", "[ladder]") {
  // Two tries of two pixels; noise that both rungs share, and a difference of 1 and 3.
  const RungImage from{"a", {{10.0, 20.0}, {12.0, 26.0}}};
  const RungImage to{"b", {{11.0, 23.0}, {13.0, 29.0}}};
  const RungStep both = rung_step(from, to, {0, 1});
  CHECK(both.bias.mean == Approx(2.0));
  CHECK(both.bias.error == Approx(0.0).margin(1e-12));
  CHECK(both.square.root() == Approx(std::sqrt(5.0)));
  CHECK(rung_step(from, to, {1}).bias.mean == Approx(3.0));
  // Against a rung without noise the scatter shows: differences -1 and 1 of mean 0 have variance of the mean 1.
  const RungStep noisy = rung_step({"c", {{11.0}}}, {"d", {{10.0}, {12.0}}}, {0});
  CHECK(noisy.bias.mean == Approx(0.0).margin(1e-12));
  CHECK(noisy.bias.error == Approx(1.0));
  CHECK(noisy.square.root() == 0.0);
}

TEST_CASE("The ladder's ends, rendered anew, are apart by what its rungs add up to", "[ladder]") {
  const StudyScene scene = cornell_point_scene();
  const View view = sized(scene.view, 16);
  const LadderOptions options = small_options(32);
  const LadderClimb climb = climb_ladder(scene, view, options, {});
  const std::vector<RungImage>& rungs = climb.rungs;
  REQUIRE(rungs.size() == 10);
  CHECK(climb.shipped == 7);
  CHECK(climb.first_parameter == rungs.size());
  CHECK(climb.warnings.empty());
  std::vector<std::string> warnings;
  const std::vector<size_t> all = all_pixels(climb);
  const std::vector<Region> regions = {{"whole", all}, {"top", {all.begin(), all.begin() + 128}}};
  const Table closed = closure(scene, view, options, climb, regions, warnings, {});
  REQUIRE(closed.rows.size() == 2);
  for (size_t k = 0; k < 2; ++k) {
    CAPTURE(closed.number(k, "gap"), closed.number(k, "gap_stderr"));
    CHECK(closed.number(k, "sum") == Approx(closed.number(k, "ends")).margin(3.0));  // percent: noise of 128 samples
    CHECK(closed.number(k, "p") > 0.01);
  }
  // Were either end another picture the gap would show it.
  for (const size_t end : {size_t{0}, rungs.size() - 1}) {
    LadderClimb broken = climb;
    for (auto& values : broken.rungs[end].tries)
      for (double& value : values) value *= 1.1;
    CHECK(closure(scene, view, options, broken, regions, warnings, {}).number(0, "p") < 0.01);
  }

  Settings settings;
  settings.grid.resolution = options.resolution;
  CHECK(rungs[climb.shipped].tries == std::vector<std::vector<double>>{cone_traced(scene, view, settings)});
  CHECK(rungs.back().tries == std::vector<std::vector<double>>{cone_traced(scene, view, shipped_settings(options))});
  // Half floats change next to nothing; bytes clamp light above 1.
  CHECK(rung_step(rungs[7], rungs[8], all).square.root() < 1e-3 * mean(rungs[0]));
  CHECK(rung_step(rungs[8], rungs[9], all).bias.mean < 0.0);
  // True rays into voxels of 1/32 of the box: nearer to the truth than six cones are.
  CHECK(rung_step(rungs[0], rungs[2], all).square.root() <
        rung_step(rungs[0], rungs[climb.shipped], all).square.root());
  // Nothing here is specular.
  CHECK(rung_named(climb, "specular") == rungs.size());
}

TEST_CASE("In a closed furnace each rung of the ladder is its closed form", "[ladder]") {
  // The sum of the rungs says nothing of those in between, which cancel in it: here each is known. Directions do not
  // matter in a furnace, but every factor, bounce and term does.
  constexpr double albedo = 0.5;
  const StudyScene scene = seen_by_first_camera("furnace", furnace(float(albedo)));
  const LadderClimb climb = climb_ladder(scene, sized(scene.view, 8), small_options(32), {});
  REQUIRE(climb.rungs.size() == 10);
  const int bounces = std::stoi(climb.rungs[1].name);
  REQUIRE(bounces > 2);
  const auto series = [&](int terms) { return (1.0 - std::pow(albedo, terms)) / (1.0 - albedo); };
  const double truth = series(1000), bounced = series(bounces + 2);
  double worst = 0.0;  // of rays into voxels that all hold the same
  for (const auto& values : climb.rungs[2].tries)
    for (const double value : values) worst = std::max(worst, std::abs(value / bounced - 1.0));
  // 8192 paths that end by roulette: their sums scatter by about a half of the mean.
  CHECK(mean(climb.rungs[0]) == Approx(truth).epsilon(0.02));
  // What longer paths bring is the rest of the series, which both images' paths show without that scatter.
  const Estimate rest = rung_step(climb.rungs[0], climb.rungs[1], all_pixels(climb)).bias;
  CAPTURE(rest.mean, rest.error, truth - bounced);
  CHECK(rest.error < 0.15 * (truth - bounced));
  // Three of these errors; one bounce more or less would be a factor of 2.
  CHECK(-rest.mean == Approx(truth - bounced).epsilon(0.4));
  CHECK(worst < 1e-5);
  // The same light in every voxel: what cones lose is what leaks out of the box, at most 0.02 of each bounce (spec 5).
  for (size_t r = 3; r <= climb.shipped + 1; ++r) {
    CAPTURE(climb.rungs[r].name, mean(climb.rungs[r]));
    CHECK(mean(climb.rungs[r]) < bounced * (1.0 + 1e-3));
    CHECK(mean(climb.rungs[r]) > bounced * (1.0 - 0.02 * albedo / (1.0 - albedo)));
  }
}

TEST_CASE("The noise of light that rays brought to the voxels is another in each try", "[ladder]") {
  const StudyScene scene = cornell_point_scene();
  LadderOptions options = small_options(16);
  options.voxel_rays = 2;
  const LadderClimb noisy = climb_ladder(scene, sized(scene.view, 16), options, {});
  options.voxel_rays = 64;
  const LadderClimb smooth = climb_ladder(scene, sized(scene.view, 16), options, {});
  const size_t r = rung_named(noisy, "radiance of voxels");
  REQUIRE(r < noisy.rungs.size());
  // The pixels' rays are the same: what is apart is the voxels' noise. It is known as noise where tries do not share
  // it.
  const std::vector<size_t> all = all_pixels(noisy);
  const RungImage one_noisy{"", {noisy.rungs[r].tries[0]}}, one_smooth{"", {smooth.rungs[r].tries[0]}};
  const double noise = rung_step(one_smooth, one_noisy, all).square.value;
  CHECK(noise > 0.0);
  // Were it the same in all tries, all of it would be taken for a difference.
  CHECK(std::abs(rung_step(smooth.rungs[r], noisy.rungs[r], all).square.value) < 0.4 * noise);
}

TEST_CASE("Where nothing is reflected twice the ladder's rays find Lambert's irradiance", "[ladder]") {
  const StudyScene scene = seen_by_first_camera("luminaire", rectangle_luminaire());
  const View view = sized(scene.view, 24);
  LadderOptions options = small_options(64);
  options.spp = options.marched_rays = 256;
  options.tries = 8;
  const LadderClimb climb = climb_ladder(scene, view, options, {});
  // The plane y = 0 of albedo 0.5 under a square of side 1 at height 1 that emits 1.
  const std::array<glm::dvec3, 4> square = {{{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}}};
  RungImage truth{"Lambert", {std::vector<double>(climb.rungs[0].tries[0].size(), 0.0)}};
  std::vector<size_t> plane;
  const Caster caster(scene.scene);
  const std::vector<SeenPoint> seen = see(scene.scene, caster, view, {}, 0.01f);
  for (size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].surface || seen[i].point.position.y > 0.5f) continue;
    plane.push_back(i);
    truth.tries[0][i] =
        0.5 * std::numbers::inv_pi * polygon_irradiance(square, glm::dvec3(seen[i].point.position), {0.0, 1.0, 0.0});
  }
  REQUIRE(plane.size() > 100);
  double light = 0.0;
  for (const size_t i : plane) light += truth.tries[0][i] / double(plane.size());
  // Paths, and rays that look the voxels up: noise alone, and what the emitter's voxels add at its edges, where their
  // rays end in a neighbour.
  for (const size_t r : {rung_named(climb, "path tracer"), rung_named(climb, " bounces"),
                         rung_named(climb, "radiance of voxels"), rung_named(climb, "cones at voxels")}) {
    REQUIRE(r < climb.rungs.size());
    const RungStep step = rung_step(truth, climb.rungs[r], plane);
    CAPTURE(climb.rungs[r].name, step.bias.mean / light, step.bias.error / light, step.square.root() / light);
    CHECK(std::abs(step.bias.mean) < 4.0 * step.bias.error + 1e-5 * light);
    CHECK(step.bias.error < 0.005 * light);
    CHECK(step.square.root(-3.0) == 0.0);
  }
}

TEST_CASE("Specular light goes from rays to one cone in a rung of its own", "[ladder]") {
  // Metal walls around a lamp: cones for diffuse light change nothing.
  Scene room;
  Material metal;
  metal.metallic = 1.0f;
  metal.roughness = 0.4f;
  metal.base_color = {0.5f, 0.6f, 0.7f, 1.0f};
  add_cube_interior(room, add_material(room, metal));
  Light lamp;
  lamp.intensity = glm::vec3(1.0f);
  lamp.position = {0.3f, 0.2f, 0.1f};
  room.lights.push_back(lamp);
  StudyScene scene{"metal", room, view_from({0.2f, 0.1f, 0.5f}, {0.0f, 0.0f, -1.0f}, 8, 8, 1.5f)};
  SECTION("metal alone") {
    const LadderClimb climb = climb_ladder(scene, sized(scene.view, 8), small_options(24), {});
    const size_t specular = rung_named(climb, "one specular cone"), narrow = rung_named(climb, "narrow cones"),
                 wide = rung_named(climb, "wide cones");
    REQUIRE(specular < climb.rungs.size());
    CHECK(climb.rungs[specular - 1].name == "rays march voxels");
    CHECK(narrow == specular + 1);
    const std::vector<size_t> all = all_pixels(climb);
    const double light = mean(climb.rungs[0]);
    CHECK(rung_step(climb.rungs[specular - 1], climb.rungs[specular], all).square.root() > 0.01 * light);
    for (size_t i = 0; i < all.size(); ++i) {  // float32 sums in another order
      CHECK(climb.rungs[narrow].tries[0][i] == Approx(climb.rungs[specular].tries[0][i]).epsilon(1e-5));
      CHECK(climb.rungs[wide].tries[0][i] == climb.rungs[narrow].tries[0][i]);
    }
  }
  SECTION("beside diffuse light, which that rung leaves to rays") {
    scene.scene.materials[0].metallic = 0.3f;
    scene.scene.materials[0].roughness = 1.0f;
    const LadderClimb climb = climb_ladder(scene, sized(scene.view, 8), small_options(24), {});
    const size_t specular = rung_named(climb, "one specular cone");
    REQUIRE(specular < climb.rungs.size());
    CHECK(climb.rungs[specular].tries.size() == size_t(small_options(24).tries));
    CHECK(climb.rungs[specular].tries[0] != climb.rungs[specular].tries[1]);
  }
}
