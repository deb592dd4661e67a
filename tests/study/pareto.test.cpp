#include "study/pareto.h"

#include <cmath>

#include "catch.h"
#include "compare/metrics.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "reference/path.h"
#include "study/cone_runner.h"
#include "study/deviation.h"
#include "study/study_scenes.h"

using namespace voxref;

TEST_CASE("The frontier holds what nothing beats in both time and error", "[study]") {
  const std::vector<Tradeoff> points = {{3.0, 0.2}, {1.0, 0.5}, {2.0, 0.6}, {2.0, 0.3}, {4.0, 0.2}, {1.0, 0.7}};
  CHECK(pareto_frontier(points) == std::vector<size_t>{1, 3, 0});
  CHECK(pareto_frontier({}).empty());
}

TEST_CASE("Settings that share stages give the bits of cone_trace alone", "[study]") {
  const StudyScene scene = cornell_point_scene();
  const Caster caster(scene.scene);
  const View view = sized(scene.view, 12);
  ConeRunner runner(scene.scene, caster, view);
  Settings settings;
  settings.grid.resolution = 20;
  settings.bounce.count = 1;
  const auto same = [&] {
    const ConeTraceResult shared = runner(settings), alone = cone_trace(scene.scene, caster, view, settings);
    for (const char* channel : {"R", "diffuse.G", "direct.B"}) {
      const auto a = shared.image.image.channel(channel), b = alone.image.image.channel(channel);
      CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    }
    CHECK(shared.seconds.voxelize > 0.0);
    CHECK(shared.seconds.total >= shared.seconds.voxelize + shared.seconds.bounce + shared.seconds.cone_trace);
  };
  same();
  settings.render.cone.diffuse = 9;  // the same volume
  same();
  settings.render.cone.step = 1.0f;  // the bounce's cones march in it too
  same();
  settings.storage = Storage::unorm8;
  same();
  settings.render.pixel.shadow = PixelShadow::visibility;
  same();
  settings.grid.resolution = 18;
  same();
}

TEST_CASE("A deviation is rel_error of cli.md, and its error bar that of independent renderings", "[study]") {
  const StudyScene scene = cornell_point_scene();
  const Caster caster(scene.scene);
  const View view = sized(scene.view, 16);
  Settings settings;
  settings.grid.resolution = 20;
  settings.bounce.count = 1;
  const Image cone = cone_trace(scene.scene, caster, view, settings).image.image;
  std::vector<double> errors;
  double bar = 0.0;
  constexpr int seeds = 24;
  for (int seed = 0; seed < seeds; ++seed) {
    PathOptions options;
    options.spp = 16;
    options.seed = static_cast<uint64_t>(seed);
    const Image path = path_trace(scene.scene, caster, view, options).image;
    const Deviation d = deviation(measured_cone(cone, true), measured_path(path, true));
    const Metrics metrics = compare(cone, path, true, 0.0f);
    CHECK(d.rel_error == Approx(metrics.rel_error).epsilon(1e-6));
    CHECK(d.bias + 1.0 == Approx(metrics.mean_ratio).epsilon(1e-6));
    errors.push_back(d.rel_error);
    bar += d.rel_error_error / seeds;
  }
  double mean = 0.0, variance = 0.0;
  for (const double e : errors) mean += e / seeds;
  for (const double e : errors) variance += (e - mean) * (e - mean) / (seeds - 1);
  // The scatter of 24 values is known to 15 %; the bar leaves out what moves the mean below the fraction.
  CHECK(bar / std::sqrt(variance) == Approx(1.0).margin(0.5));
}

TEST_CASE("A small pareto study has a row per setting, a frontier and error bars", "[study]") {
  const ParetoGrid grid{{16, 24}, {4, 9}, {1.0f}, {0}, {Storage::float32}, 12, 64, 4, 2};
  const Section section = pareto_section(cornell_point_scene(), grid, {});
  REQUIRE(section.tables.size() == 2);
  CHECK(section.tables[0].rows.size() == 4);
  CHECK(section.tables[1].rows.size() == 3);
  CHECK(section.charts.size() == 1);
  for (size_t i = 0; i < 4; ++i) {
    CHECK(section.tables[0].number(i, "time") > 0.0);
    CHECK(section.tables[0].number(i, "rel_error") > 0.05);
    CHECK(section.tables[0].number(i, "rel_error_95") > 0.0);
  }
}
