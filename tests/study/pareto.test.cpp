#include "study/pareto.h"

#include <cmath>
#include <limits>
#include <mutex>
#include <set>

#include "catch.h"
#include "make_scenes/builders.h"
#include "reference/path.h"
#include "study/deviation.h"
#include "study/study_scenes.h"

using namespace voxref;

TEST_CASE("The frontier holds what nothing beats in both time and error", "[study]") {
  const std::vector<Tradeoff> points = {{3.0, 0.2}, {1.0, 0.5}, {2.0, 0.6}, {2.0, 0.3}, {4.0, 0.2}, {1.0, 0.7}};
  CHECK(pareto_frontier(points) == std::vector<size_t>{1, 3, 0});
  CHECK(pareto_frontier({}).empty());
  // What has no error is not the best of all, though no number is below it.
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(pareto_frontier(std::vector<Tradeoff>{{1.0, none}, {2.0, 0.3}, {2.0, none}, {3.0, 0.2}}) ==
        std::vector<size_t>{1, 3});
  CHECK(pareto_frontier(std::vector<Tradeoff>{{1.0, none}}).empty());
}

TEST_CASE("A small pareto study has a row per setting, a frontier and error bars", "[study]") {
  const ParetoGrid grid{{{16, 24}, {0}, {Storage::float32}, {1.0f}, {4, 9}}, 12, 64, 4, 2, 2};
  const Section section = pareto_section(cornell_point_scene(), grid, {});
  REQUIRE(section.tables.size() == 2);
  CHECK(section.tables[0].rows.size() == 4);
  CHECK(section.tables[1].rows.size() == 3);
  CHECK(section.charts.size() == 1);
  for (const Table& table : section.tables)
    for (size_t i = 0; i < table.rows.size(); ++i) {
      CAPTURE(table.name, i);
      CHECK(table.number(i, "time_least") > 0.0);
      CHECK(table.number(i, "time_least") <= table.number(i, "time"));
      CHECK(table.number(i, "time") <= table.number(i, "time_greatest"));
      CHECK(table.number(i, "rel_error_low") < table.number(i, "rel_error"));
      CHECK(table.number(i, "rel_error") < table.number(i, "rel_error_high"));
    }
  // Without bounces the box misses more than a tenth of its light, whatever the cones.
  for (size_t i = 0; i < 4; ++i) CHECK(section.tables[0].number(i, "rel_error_low") > 0.1);
}

TEST_CASE("What takes long is timed in one round, and progress says which setting it is at", "[study]") {
  ParetoGrid grid{{{16, 24}, {0}, {Storage::float32}, {1.0f}, {4}}, 12, 64, 1, 2, 3};
  const auto rounds = [&](double long_enough, const Progress& progress) {
    grid.long_enough = long_enough;
    const Table cones = pareto_section(cornell_point_scene(), grid, progress).tables[0];
    return std::vector{cones.number(0, "rounds"), cones.number(1, "rounds")};
  };
  std::mutex mutex;  // threads report on their own
  std::set<std::string> settings;
  Progress progress;
  progress.report = [&](std::string_view stage, double) {
    const std::lock_guard lock(mutex);
    if (const size_t comma = stage.find(','); comma != stage.npos) settings.insert(std::string(stage.substr(0, comma)));
  };
  CHECK(rounds(0.0, progress) == std::vector{1.0, 1.0});  // nothing takes less than no time
  CHECK(settings == std::set<std::string>{"setting 1 of 2", "setting 2 of 2"});
  CHECK(rounds(1e9, {}) == std::vector{3.0, 3.0});
}

TEST_CASE("Error bars of few seeds are those of Student's distribution", "[study]") {
  // Two seeds: the mean -+ 12.7 standard errors, which are half of what separates the two; 0 at least.
  const ParetoGrid grid{{{16}, {0}, {Storage::float32}, {1.0f}, {4}}, 12, 64, 1, 2, 1};
  const Table paths = pareto_section(cornell_point_scene(), grid, {}).tables[1];
  CHECK(paths.number(0, "rel_error_low") == 0.0);
  const StudyScene scene = cornell_point_scene();
  const View view = sized(scene.view, 12);
  const Caster caster(scene.scene);
  const auto traced = [&](int spp, int randomizations, uint64_t seed) {
    PathOptions options;
    options.spp = spp;
    options.randomizations = randomizations;
    options.seed = seed;
    return measured_path(path_trace(scene.scene, caster, view, options).image, true);
  };
  const Measured truth = traced(64, 16, 0);
  std::vector<double> errors;
  for (uint64_t seed : {1, 2}) {
    Measured image = traced(1, 1, seed);
    image.standard_error.assign(image.value.size(), 0.0);
    errors.push_back(deviation(image, truth).rel_error());
  }
  const double half = 0.5 * std::abs(errors[0] - errors[1]);
  CHECK(paths.number(0, "rel_error") == Approx(0.5 * (errors[0] + errors[1])).epsilon(1e-9));
  CHECK(paths.number(0, "rel_error_high") - paths.number(0, "rel_error") == Approx(12.706 * half).epsilon(1e-4));
}

TEST_CASE("A study of images that are not finite says so, and draws no frontier through them", "[study]") {
  const ParetoGrid grid{{{16}, {0}, {Storage::float32}, {1.0f}, {4, 9}}, 12, 64, 1, 2, 1};
  StudyScene plane = seen_by_first_camera("plane", point_light_over_plane());
  plane.view.background.g = std::numeric_limits<float>::quiet_NaN();
  const Section section = pareto_section(plane, grid, {});
  for (size_t i = 0; i < 2; ++i) {
    CHECK(section.tables[0].number(i, "nonfinite") > 0.0);
    CHECK(std::isnan(section.tables[0].number(i, "rel_error")));
    CHECK(section.tables[0].rows[i].back() == Cell(std::string()));  // not on the frontier
  }
  CHECK(section.text.find("Images of 2 settings have pixels that are NaN") != std::string::npos);
  CHECK(section.text.find("contributions of the path tracer are NaN") != std::string::npos);
  // So do the images that are held against the truth: one sample, of two seeds.
  const View view = sized(plane.view, 12);
  uint64_t missing = 0;
  for (uint64_t seed : {1, 2}) {
    PathOptions options;
    options.spp = options.randomizations = 1;
    options.seed = seed;
    missing += path_trace(plane.scene, Caster(plane.scene), view, options).nonfinite;
  }
  CHECK(missing > 0);
  CHECK(section.tables[1].number(0, "nonfinite") == double(missing));
  CHECK(section.text.find(std::to_string(missing) + " contributions to the path tracer's images of 2 seeds are NaN") !=
        std::string::npos);
}

TEST_CASE("A scene without indirect light has a chart of its direct light", "[study]") {
  const ParetoGrid grid{{{16}, {0}, {Storage::float32}, {1.0f}, {4}}, 12, 64, 1, 2, 1};
  const StudyScene plane = seen_by_first_camera("plane", point_light_over_plane());
  const Section section = pareto_section(plane, grid, {});
  CHECK(section.charts[0].title.find("whole light") != std::string::npos);
  CHECK(std::isfinite(section.tables[0].number(0, "rel_error")));
}
