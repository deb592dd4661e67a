#include "study/plan.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "make_scenes/builders.h"
#include "study/study_scenes.h"

using namespace voxref;

namespace {

/// Measures every point: the slow, obviously right search.
PlanSearch exhaustive_search(const SettingSpace& space, double budget, const PlanOracle& oracle) {
  PlanSearch search;
  for (const SettingPoint& point : all_points(space)) {
    search.trials.push_back(oracle.measure(point));
    const PlanTrial& trial = search.trials.back();
    if (!search.closest || trial.rel_error < search.closest->rel_error) search.closest = trial;
  }
  for (const PlanTrial& trial : search.trials)
    if (trial.rel_error <= budget && (!search.best || oracle.cost(trial.point) < oracle.cost(search.best->point)))
      search.best = trial;
  return search;
}

/// The predicted time of a setting by the table of another plan, so that both use one model.
double time_in(const Table& trials, const Settings& settings) {
  const std::vector<Cell> wanted = setting_cells(settings);
  for (size_t i = 0; i < trials.rows.size(); ++i)
    if (std::equal(wanted.begin(), wanted.end(), trials.rows[i].begin())) return trials.number(i, "time");
  return std::numeric_limits<double>::quiet_NaN();
}

/// Plans for the scene within the budgets, and holds each plan against all settings of the space.
void check_against_exhaustive(const StudyScene& scene, int width, PlanOptions options,
                              const std::vector<double>& budgets) {
  const Caster caster(scene.scene);
  const View view = sized(scene.view, width);
  const Settings base;
  PlanOptions slow = options;
  slow.budget = 0.0;
  slow.search = exhaustive_search;
  const Plan everything = make_plan(scene.scene, caster, view, base, slow);
  for (const double budget : budgets) {
    options.budget = budget;
    const Plan plan = make_plan(scene.scene, caster, view, base, options);
    double cheapest = std::numeric_limits<double>::infinity();
    std::string cheapest_words = "nothing";
    for (size_t i = 0; i < everything.trials.rows.size(); ++i)
      if (everything.trials.number(i, "rel_error") <= budget && everything.trials.number(i, "time") < cheapest) {
        cheapest = everything.trials.number(i, "time");
        cheapest_words.clear();
        for (size_t c = 0; c < setting_columns().size(); ++c)
          cheapest_words += display(everything.trials.rows[i][c]) + " ";
      }
    const double time = plan.best ? time_in(everything.trials, plan.best->settings) : cheapest;
    std::cout << fmt::format(
        "{:<18} {:>4.0f} %  plan {:<52} {:.3g} s, best {:<32} {:.3g} s; {} of {} measured, {:.1f} % "
        "of the work\n",
        scene.name, 100 * budget, plan.best ? setting_words(plan.best->settings) : "nothing", time, cheapest_words,
        cheapest, plan.trials.rows.size(), everything.trials.rows.size(), 100 * plan.seconds / everything.seconds);
    CAPTURE(scene.name, budget, plan.trials.rows.size(), plan.seconds, everything.seconds);
    CHECK(plan.best.has_value() == std::isfinite(cheapest));
    if (plan.best) CHECK(time <= 1.25 * cheapest);
    CHECK(plan.seconds <= 0.1 * everything.seconds);
    if (plan.cheaper) CHECK(plan.cheaper->seconds < plan.best->seconds);
    if (plan.better) CHECK(plan.better->rel_error < plan.best->rel_error);
  }
}

}  // namespace

TEST_CASE("The plan for a real scene is as cheap as an exhaustive search's, at a tenth of its work", "[plan]") {
  // Rates are given, so that no clock decides. At this size everything takes seconds.
  PlanOptions options;
  options.space = {
      {16, 32, 64}, {0, 1, 3}, {Storage::unorm8, Storage::float16, Storage::float32}, {1.0f, 0.5f}, {4, 9, 16}};
  options.width = 8;
  options.reference_spp = 256;
  options.rates = StageRates{};
  check_against_exhaustive(cornell_point_scene(), 128, options, {0.5, 0.3});
}

namespace {

/// Budgets of 40, 20 and 10 %. Work is counted by fixed rates, so that a busy machine decides nothing. All resolutions
/// are halved: 256 voxels would take the exhaustive search, and nothing else, four times as long.
void check_plans_of(const StudyScene& scene) {
  PlanOptions options;
  options.rates = StageRates{};
  options.space.resolutions = {16, 32, 64, 128};
  check_against_exhaustive(scene, 512, options, {0.4, 0.2, 0.1});
}

}  // namespace

TEST_CASE("Plans for the Cornell box are as cheap as an exhaustive search's", "[.long][plan]") {
  check_plans_of(cornell_point_scene());
}

TEST_CASE("Plans for Light Box are as cheap as an exhaustive search's", "[.long][plan]") {
  check_plans_of(light_box_scene());
}

TEST_CASE("Plans for Sponza are as cheap as an exhaustive search's", "[.long][plan]") {
  const auto file = shared_file("assets/scenes/sponza.glb");
  if (!file) VOXREF_SKIP("sponza.glb is absent");
  check_plans_of(*public_scene("sponza", file->parent_path().parent_path().parent_path(), false));
}

TEST_CASE("A scene without light is planned: black against black is no error", "[plan]") {
  Scene scene = cornell_box(CornellLight::point);
  scene.lights.clear();
  const Caster caster(scene);
  View view;
  view.camera = scene.cameras.at(0);
  PlanOptions options;
  options.space = {{16, 24}, {0, 1}, {Storage::unorm8}, {1.0f}, {4, 6}};
  options.width = 8;
  options.reference_spp = 16;
  options.rates = StageRates{};
  const Plan plan = make_plan(scene, caster, sized(view, 64), {}, options);
  REQUIRE(plan.best);
  CHECK(plan.best->rel_error == 0.0);
  CHECK(plan.best->settings.grid.resolution == 16);
  CHECK(!plan.better);
  // Not a number would be passed over in silence.
  options.search = [](const SettingSpace& space, double budget, const PlanOracle& oracle) {
    CHECK(oracle.noise == 0.0);
    for (const double d : oracle.measure({}).difference) CHECK(d == 0.0);
    return search_plan(space, budget, oracle);
  };
  make_plan(scene, caster, sized(view, 64), {}, options);
}

TEST_CASE("No budget is reached by images with a NaN, and the plan says how many pixels", "[plan]") {
  const Scene scene = point_light_over_plane();
  View view;
  view.camera = scene.cameras.at(0);
  view.background.g = std::numeric_limits<float>::quiet_NaN();
  PlanOptions options;
  options.space = {{16, 24}, {0}, {Storage::float32}, {1.0f}, {4, 6}};
  options.width = 8;
  options.reference_spp = 16;
  options.budget = 1e6;
  const Plan plan = make_plan(scene, Caster(scene), sized(view, 64), {}, options);
  CHECK(!plan.best);
  CHECK(plan.closest.nonfinite > 0);
  CHECK(std::isnan(plan.closest.rel_error));
  for (size_t i = 0; i < plan.trials.rows.size(); ++i) CHECK(plan.trials.number(i, "nonfinite") > 0.0);
  REQUIRE(plan.not_finite.size() == 2);
  CHECK(plan.not_finite[0].find("contributions of the path tracer are NaN") != std::string::npos);
  CHECK(plan.not_finite[1].find(fmt::format("up to {}", plan.closest.nonfinite)) != std::string::npos);
}

TEST_CASE("The memory that a plan names is that of the run at full size", "[plan]") {
  const Scene scene = cornell_box(CornellLight::point);
  const Caster caster(scene);
  View view;
  view.camera = scene.cameras.at(0);
  view = sized(view, 96);
  PlanOptions options;
  options.space = {{16, 32}, {0, 1}, {Storage::unorm8, Storage::float32}, {1.0f}, {4, 9}};
  options.width = 8;
  options.reference_spp = 64;
  options.rates = StageRates{};
  options.budget = 0.4;
  const Plan plan = make_plan(scene, caster, view, {}, options);
  REQUIRE(plan.best);
  for (const auto& planned : {plan.best, plan.cheaper, plan.better, std::optional(plan.closest)}) {
    if (!planned) continue;
    const ConeTraceResult full = cone_trace(scene, caster, view, planned->settings);
    const Image& image = full.image.image;
    const size_t bytes = full.bytes.at("total") + image.pixel_count() * image.channels().size() * sizeof(float);
    CAPTURE(setting_words(planned->settings));
    // Volumes do not know the image's size. A vector that was copied, as the runner copies surfaces, may have less
    // room to spare than one that grew: 1 %.
    CHECK(double(planned->bytes) == Approx(double(bytes)).epsilon(0.01));
  }
}

TEST_CASE("The next steps and the plan have the times of its table", "[plan]") {
  // Times are learned from the clock, which decides what the plan is, but not whether it agrees with itself.
  PlanOptions options;
  options.space = {{16, 24, 32}, {0, 1}, {Storage::unorm8, Storage::float32}, {1.0f, 0.5f}, {4, 9, 16}};
  options.width = 8;
  options.reference_spp = 64;
  const StudyScene scene = cornell_point_scene();
  for (const double budget : {0.6, 0.4}) {
    options.budget = budget;
    const Plan plan = make_plan(scene.scene, Caster(scene.scene), sized(scene.view, 64), {}, options);
    CHECK(plan.seconds > 0.0);
    CHECK(plan.reference_seconds > 0.0);
    for (const auto& planned : {plan.best, plan.cheaper, plan.better, std::optional(plan.closest)})
      if (planned) CHECK(time_in(plan.trials, planned->settings) == planned->seconds);
    for (size_t i = 0; i < plan.trials.rows.size(); ++i)
      if (plan.trials.number(i, "rel_error") <= budget) {
        REQUIRE(plan.best);
        CHECK(plan.best->seconds <= plan.trials.number(i, "time"));
      }
  }
}

TEST_CASE("A plan's settings come back from its JSON and its flags", "[plan]") {
  Settings settings = profile("villegas2016");
  settings.grid.resolution = 64;
  settings.grid.bounds = Bounds{{-1.0f, 0.0f, -1.5f}, {1.0f, 2.0f, 1.5f}};
  settings.light.attenuation = {0.0f, 0.5f, 0.25f};
  settings.storage = Storage::float16;
  settings.render.cone.step = 0.25f;
  settings.bounce.count.reset();
  const nlohmann::json bounds = {{-1.0, 0.0, -1.5}, {1.0, 2.0, 1.5}};
  CHECK(config(settings) == nlohmann::json{{"profile", "villegas2016"},
                                           {"grid", {{"resolution", 64}, {"bounds", bounds}}},
                                           {"storage", "float16"},
                                           {"light", {{"attenuation", {0.0, 0.5, 0.25}}}},
                                           {"cone", {{"step", 0.25}}},
                                           {"bounce", {{"count", "auto"}}}});
  Settings from_json, from_flags = profile(settings.profile);
  apply_json(from_json, config(settings));
  CHECK(to_json(from_json) == to_json(settings));
  for (const std::string& assignment : assignments(settings)) apply_assignment(from_flags, assignment);
  CHECK(to_json(from_flags) == to_json(settings));
  CHECK(assignments(settings).size() == 6);  // one for each parameter that differs
}

TEST_CASE("Settings that are the profile's own take no flags but its name", "[plan]") {
  for (const char* name : {"radiometric", "villegas2016"}) {
    CHECK(assignments(profile(name)).empty());
    CHECK(config(profile(name)) == nlohmann::json{{"profile", name}});
  }
}
