#include "study/ladder.h"

#include <algorithm>
#include <cmath>

#include "catch.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "study/ladder_charts.h"
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
  const LadderClimb climb = climb_ladder(scene, view, options, {});
  const std::vector<RungImage>& rungs = climb.rungs;
  REQUIRE(rungs.size() == 10);
  CHECK(climb.shipped == 7);
  CHECK(climb.first_published == rungs.size());
  std::vector<Region> regions = {{"whole", {}}, {"top", {}}};
  for (size_t i = 0; i < rungs[0].tries[0].size(); ++i) {
    regions[0].pixels.push_back(i);
    if (i < rungs[0].tries[0].size() / 2) regions[1].pixels.push_back(i);
  }
  const Table closed = closure(scene, view, options, climb, regions, {});
  REQUIRE(closed.rows.size() == 2);
  for (size_t k = 0; k < 2; ++k) {
    double sum = 0.0;
    for (size_t r = 1; r < rungs.size(); ++r) sum += rung_step(rungs[r - 1], rungs[r], regions[k].pixels).bias.mean;
    CHECK(sum == Approx(rung_step(rungs.front(), rungs.back(), regions[k].pixels).bias.mean).epsilon(1e-9));
    CAPTURE(closed.number(k, "gap"), closed.number(k, "gap_stderr"));
    CHECK(closed.number(k, "sum") == Approx(closed.number(k, "ends")).margin(3.0));  // percent: noise of 128 samples
    CHECK(closed.number(k, "p") > 0.01);
  }
  // Where one end was another picture the gap shows.
  LadderClimb broken = climb;
  for (double& value : broken.rungs.back().tries[0]) value *= 1.1;
  CHECK(closure(scene, view, options, broken, regions, {}).number(0, "p") < 0.01);

  const Caster caster(scene.scene);
  Settings settings;
  settings.grid.resolution = options.resolution;
  const Image shipped = cone_trace(scene.scene, caster, view, settings).image.image;
  CHECK(rungs[climb.shipped].tries == std::vector<std::vector<double>>{measured_cone(shipped, false).value});
  // Half floats change next to nothing; bytes clamp light above 1.
  const auto& all = regions[0].pixels;
  CHECK(rung_step(rungs[7], rungs[8], all).square.root() < 1e-3 * mean(rungs[0]));
  CHECK(rung_step(rungs[8], rungs[9], all).bias.mean < 0.0);
  // True rays into voxels of 1/32 of the box: nearer to the truth than six cones are.
  CHECK(rung_step(rungs[0], rungs[2], all).square.root() <
        rung_step(rungs[0], rungs[climb.shipped], all).square.root());
}

TEST_CASE("Regions of a ladder are lit where light falls straight, also from glowing surfaces", "[ladder]") {
  StudyScene scene{"lamp", cornell_box(CornellLight::area), {}};
  scene.view.camera = scene.scene.cameras.at(0);
  LadderOptions options;
  options.resolution = 16;
  options.width = 12;
  options.tries = 2;
  options.spp = 16;
  options.marched_rays = options.voxel_rays = 4;
  options.narrow_cones = 16;
  options.published = false;
  const Section section = ladder_section(scene, options, {}, {});
  std::vector<std::string> regions;
  for (size_t i = 0; i < section.tables[1].rows.size(); ++i)
    regions.push_back(std::get<std::string>(section.tables[1].rows[i][0]));
  CHECK(std::find(regions.begin(), regions.end(), "lit") != regions.end());
  // A waterfall for each, and the chart of RMS changes.
  CHECK(section.charts.size() == regions.size() + 1);
}
