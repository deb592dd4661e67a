#include "study/ladder.h"

#include <cmath>
#include <numeric>

#include "catch.h"
#include "pipeline.h"
#include "reference/path.h"
#include "study/deviation.h"
#include "study/study_scenes.h"

using namespace voxref;

TEST_CASE("A step between rungs is their paired difference, its noise taken out", "[ladder]") {
  // Two tries of two pixels; noise that both rungs share, and a difference of 1 and 3.
  const RungImage from{"a", {{10.0, 20.0}, {12.0, 26.0}}};
  const RungImage to{"b", {{11.0, 23.0}, {13.0, 29.0}}};
  const RungStep both = rung_step(from, to, {0, 1});
  CHECK(both.bias == Approx(2.0));
  CHECK(both.bias_error == Approx(0.0).margin(1e-12));
  CHECK(both.rms == Approx(std::sqrt(5.0)));
  CHECK(rung_step(from, to, {1}).bias == Approx(3.0));
  // Against a rung without noise the scatter shows: differences -1 and 1 of mean 0 have variance of the mean 1.
  const RungStep noisy = rung_step({"c", {{11.0}}}, {"d", {{10.0}, {12.0}}}, {0});
  CHECK(noisy.bias == Approx(0.0).margin(1e-12));
  CHECK(noisy.bias_error == Approx(1.0));
  CHECK(noisy.rms == 0.0);
}

TEST_CASE("The ladder's biases add up to what separates independent images of its ends", "[ladder]") {
  const StudyScene scene = cornell_point_scene();
  const View view = sized(scene.view, 16);
  LadderOptions options;
  options.resolution = 32;
  options.tries = 4;
  options.spp = 32;
  options.marched_rays = 8;
  options.voxel_rays = 16;
  options.narrow_cones = 64;
  options.published = false;
  size_t published = 0;
  const std::vector<RungImage> rungs = climb_ladder(scene, view, options, published, {});
  REQUIRE(rungs.size() == 8);
  CHECK(published == rungs.size());
  std::vector<size_t> all(rungs[0].tries[0].size());
  std::iota(all.begin(), all.end(), size_t{0});
  double sum = 0.0;
  for (size_t r = 1; r < rungs.size(); ++r) sum += rung_step(rungs[r - 1], rungs[r], all).bias;
  const RungStep total = rung_step(rungs.front(), rungs.back(), all);
  CHECK(sum == Approx(total.bias).epsilon(1e-9));

  // Both ends once more, by the programs' own calls and another seed.
  const Caster caster(scene.scene);
  PathOptions path;
  path.spp = 512;
  path.seed = 99;
  const Measured truth = measured_path(path_trace(scene.scene, caster, view, path).image, false);
  Settings settings;
  settings.grid.resolution = options.resolution;
  const Measured cone = measured_cone(cone_trace(scene.scene, caster, view, settings).image.image, false);
  double variance = total.bias_error * total.bias_error;
  for (const double s : truth.standard_error) variance += s * s / double(all.size() * all.size());
  CAPTURE(sum, cone.mean() - truth.mean(), std::sqrt(variance));
  CHECK(std::abs(sum - (cone.mean() - truth.mean())) < 4.0 * std::sqrt(variance));  // t of 3 degrees: once in 35
  CHECK(rungs.back().tries == std::vector<std::vector<double>>{cone.value});
  // True rays into voxels of 1/32 of the box: nearer to the truth than six cones are.
  CHECK(rung_step(rungs[0], rungs[2], all).rms < rung_step(rungs[0], rungs.back(), all).rms);
}
