#include "study/plan.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "make_scenes/builders.h"
#include "study/planner.h"
#include "study/study_scenes.h"

using namespace voxref;

namespace {

/// Every point of the space.
std::vector<PlanPoint> all_points(const PlanSpace& space) {
  std::vector<PlanPoint> points(1);
  for (size_t axis = 0; axis < PlanSpace::axes; ++axis) {
    std::vector<PlanPoint> longer;
    for (PlanPoint point : points)
      for (point[axis] = 0; point[axis] < space.size(axis); ++point[axis]) longer.push_back(point);
    points = longer;
  }
  return points;
}

/// A world in which every coarser value adds to the square of the error and finer ones cost more.
struct SyntheticWorld {
  PlanSpace space;
  double spent = 0.0;

  double error(const PlanPoint& p) const {
    const double cones = 0.9 / space.cones[p[2]], bounces = 0.5 * std::pow(0.4, double(p[1]));
    const double resolution = 4.0 / space.resolutions[p[0]], step = 0.03 * double(1 - p[3]),
                 storage = 0.1 * double(p[4] == 0);
    return std::sqrt(cones * cones + bounces * bounces + resolution * resolution + step * step + storage * storage);
  }
  double cost(const PlanPoint& p) const {
    const double side = space.resolutions[p[0]];
    return (1.0 + double(p[3])) * (side * side * (1.0 + double(p[1])) + 2e3 * space.cones[p[2]]) *
           (1.0 + 0.05 * double(p[4]));
  }
  /// Of a small image: the volume counts.
  double effort(const PlanPoint& p) const {
    const double side = space.resolutions[p[0]];
    return (1.0 + double(p[3])) * (side * side * (1.0 + double(p[1])) + 20.0 * space.cones[p[2]]);
  }
  PlanOracle oracle() {
    return {[this](const PlanPoint& p) {
              spent += effort(p);
              return PlanTrial{p, error(p), 0.0};
            },
            [this](const PlanPoint& p) { return cost(p); }};
  }
};

/// Measures every point: the slow, obviously right search.
PlanSearch exhaustive_search(const PlanSpace& space, double budget, const PlanOracle& oracle) {
  PlanSearch search;
  for (const PlanPoint& point : all_points(space)) {
    search.trials.push_back(oracle.measure(point));
    const PlanTrial& trial = search.trials.back();
    if (!search.closest || trial.error < search.closest->error) search.closest = trial;
  }
  for (const PlanTrial& trial : search.trials)
    if (trial.error <= budget && (!search.best || oracle.cost(trial.point) < oracle.cost(search.best->point)))
      search.best = trial;
  return search;
}

/// The predicted time of a setting by the table of another plan, so that both use one model.
double time_in(const Table& trials, const Settings& settings) {
  const nlohmann::json s = to_json(settings);
  const nlohmann::json& bounces = s["bounce"]["count"];
  const std::vector<Cell> wanted = {s["grid"]["resolution"].get<double>(),
                                    bounces.is_string() ? "auto" : bounces.dump(), s["cone"]["diffuse"].get<double>(),
                                    s["cone"]["step"].get<double>(), s["storage"].get<std::string>()};
  for (size_t i = 0; i < trials.rows.size(); ++i)
    if (std::equal(wanted.begin(), wanted.end(), trials.rows[i].begin())) return trials.number(i, "time");
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

TEST_CASE("The search finds the cheapest setting of a world whose errors add up, or that there is none", "[plan]") {
  for (const double budget : {0.6, 0.4, 0.2, 0.1, 0.05, 0.03, 0.001}) {
    SyntheticWorld world;
    const PlanSearch search = search_plan(world.space, budget, world.oracle());
    double cheapest = std::numeric_limits<double>::infinity();
    for (const PlanPoint& p : all_points(world.space))
      if (world.error(p) <= budget) cheapest = std::min(cheapest, world.cost(p));
    CAPTURE(budget, world.spent);
    CHECK(search.best.has_value() == std::isfinite(cheapest));
    CHECK(search.closest.has_value());
    if (search.best) CHECK(world.cost(search.best->point) <= 1.25 * cheapest);
    double all = 0.0;
    for (const PlanPoint& p : all_points(world.space)) all += world.effort(p);
    CHECK(world.spent <= 0.1 * all);
  }
}

TEST_CASE("The plan for a real scene is as cheap as an exhaustive search's", "[plan]") {
  // Rates are given, so that no clock decides. At this size everything takes seconds.
  PlanOptions options;
  options.space = {{16, 20, 24}, {0, 1, std::nullopt}, {4, 9, 16}, {1.0f, 0.5f}, {Storage::unorm8, Storage::float32}};
  options.width = 12;
  options.reference_spp = 256;
  options.rates = StageRates{};
  for (const StudyScene& scene : {cornell_point_scene(), light_box_scene()}) {
    const Caster caster(scene.scene);
    const View view = sized(scene.view, 128);
    const Settings base;
    PlanOptions slow = options;
    slow.budget = 0.0;
    slow.search = exhaustive_search;
    const Plan everything = make_plan(scene.scene, caster, view, base, slow);
    for (const double budget : {0.4, 0.2, 0.1}) {
      options.budget = budget;
      const Plan plan = make_plan(scene.scene, caster, view, base, options);
      double cheapest = std::numeric_limits<double>::infinity();
      for (size_t i = 0; i < everything.trials.rows.size(); ++i)
        if (everything.trials.number(i, "rel_error") <= budget)
          cheapest = std::min(cheapest, everything.trials.number(i, "time"));
      CAPTURE(scene.name, budget, plan.trials.rows.size(), plan.seconds, everything.seconds);
      CHECK(plan.best.has_value() == std::isfinite(cheapest));
      if (plan.best) CHECK(time_in(everything.trials, plan.best->settings) <= 1.25 * cheapest);
      CHECK(plan.seconds <= 0.5 * everything.seconds);  // a third of these 108 settings are at the coarsest resolution
    }
  }
}

TEST_CASE("A plan drops what the scene does not use", "[plan]") {
  const Scene open = point_light_over_plane();
  const Caster caster(open);
  const Visibility visibility = measure_visibility(open, caster);
  CHECK(visibility.hit_share == 0.0);
  PlanSpace space;
  CHECK(drop_unused(space, open, visibility, glm::vec3(0.0f)).size() == 3);
  CHECK(space.bounces == std::vector<std::optional<int>>{0});
  CHECK(space.cones.size() == 1);
  const Scene room = cornell_box(CornellLight::area);
  PlanSpace all;
  CHECK(drop_unused(all, room, measure_visibility(room, Caster(room)), glm::vec3(0.0f)).size() == 1);  // not specular
  CHECK(all.bounces.size() == PlanSpace{}.bounces.size());
}

TEST_CASE("Rays between the walls of a closed cube are as long as its mean chord", "[plan]") {
  // Convex body, cosine-distributed from the surface: 4 V / S = 4/3 of the half side for a cube of side 2.
  const Scene cube = furnace(0.5f);
  const Visibility visibility = measure_visibility(cube, Caster(cube));
  CHECK(visibility.hit_share == 1.0);
  CHECK(visibility.mean_distance == Approx(4.0 / 3.0).epsilon(0.02));  // 4096 rays whose lengths scatter by a half
}

TEST_CASE("The model's look-ups are those of a march", "[plan]") {
  for (const double step : {1.0, 0.5})
    for (const double tangent : {0.05, 0.3, 0.66}) {
      double s = 0.0;
      int counted = 0;
      for (; s < 100.0; ++counted) s += step * std::max(1.0, 2.0 * tangent * s);
      CAPTURE(step, tangent, counted);
      CHECK(CostModel::look_ups(tangent, step, 100.0) == Approx(counted).margin(2.0));  // the ends are cut differently
    }
}

TEST_CASE("A plan's settings come back from its JSON and its flags", "[plan]") {
  Settings settings = profile("villegas2016");
  settings.grid.resolution = 64;
  settings.render.cone.step = 0.25f;
  settings.bounce.count.reset();
  CHECK(config(settings) == nlohmann::json{{"profile", "villegas2016"},
                                           {"grid", {{"resolution", 64}}},
                                           {"cone", {{"step", 0.25}}},
                                           {"bounce", {{"count", "auto"}}}});
  Settings again;
  apply_json(again, config(settings));
  CHECK(to_json(again) == to_json(settings));
  CHECK(assignments(settings) ==
        "--profile villegas2016 --set bounce.count=auto --set cone.step=0.25 --set grid.resolution=64");
}
