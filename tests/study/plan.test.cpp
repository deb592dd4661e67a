#include "study/plan.h"

#include <cmath>
#include <limits>

#include "catch.h"
#include "make_scenes/builders.h"

using namespace voxref;

namespace {

/// A world whose images have five pixels, each with what one parameter does to it, and finer values cost more.
struct SyntheticWorld {
  SettingSpace space;
  double spent = 0.0;

  std::vector<double> difference(const SettingPoint& p) const {
    const double scale = std::sqrt(double(setting_axes));
    return {scale * 4.0 / space.resolutions[p[resolution_axis]], scale * 0.5 * std::pow(0.4, double(p[bounce_axis])),
            scale * 0.1 * double(p[storage_axis] == 0), scale * 0.03 * double(1 - p[step_axis]),
            scale * 0.9 / space.cones[p[cone_axis]]};
  }
  double error(const SettingPoint& p) const {
    double square = 0.0;
    for (const double d : difference(p)) square += d * d / double(setting_axes);
    return std::sqrt(square);
  }
  double cost(const SettingPoint& p) const {
    const double side = space.resolutions[p[resolution_axis]];
    return (1.0 + double(p[step_axis])) *
           (side * side * (1.0 + double(p[bounce_axis])) + 2e3 * space.cones[p[cone_axis]]) *
           (1.0 + 0.05 * double(p[storage_axis]));
  }
  /// Of a small image: the volume counts.
  double effort(const SettingPoint& p) const {
    const double side = space.resolutions[p[resolution_axis]];
    return (1.0 + double(p[step_axis])) *
           (side * side * (1.0 + double(p[bounce_axis])) + 20.0 * space.cones[p[cone_axis]]);
  }
  PlanOracle oracle() {
    return {[this](const SettingPoint& p) {
              spent += effort(p);
              return PlanTrial{p, error(p), 0.0, difference(p)};
            },
            [this](const SettingPoint& p) { return cost(p); }};
  }
};

}  // namespace

TEST_CASE("The search finds the cheapest setting of a world whose errors add up, or that there is none", "[plan]") {
  for (const double budget : {0.6, 0.4, 0.2, 0.1, 0.05, 0.03, 0.001}) {
    SyntheticWorld world;
    const PlanSearch search = search_plan(world.space, budget, world.oracle());
    double cheapest = std::numeric_limits<double>::infinity(), all = 0.0;
    for (const SettingPoint& p : all_points(world.space)) {
      if (world.error(p) <= budget) cheapest = std::min(cheapest, world.cost(p));
      all += world.effort(p);
    }
    CAPTURE(budget, world.spent, all);
    CHECK(search.best.has_value() == std::isfinite(cheapest));
    CHECK(search.closest.has_value());
    if (search.best) CHECK(world.cost(search.best->point) <= 1.25 * cheapest);
    CHECK(world.spent <= 0.1 * all);
  }
}

TEST_CASE("A budget far out of reach is given up before the finest resolution is paid for", "[plan]") {
  // Errors halve from resolution to resolution, from 0.13 at the coarsest: 0.001 is seven of them away, not three.
  SyntheticWorld world;
  const PlanSearch search = search_plan(world.space, 0.001, world.oracle());
  CHECK(!search.best);
  for (const PlanTrial& trial : search.trials)
    CHECK(trial.point[resolution_axis] + 1 < world.space.size(resolution_axis));
}

TEST_CASE("Noise of the truth, which every difference holds, hides no setting that is within the budget", "[plan]") {
  // As large as a budget that no setting of the coarsest resolution reaches: predictions that counted it would pass all
  // by, or pay for more than it takes.
  constexpr double budget = 0.1, noise = budget * budget;
  SyntheticWorld world, noisy;
  PlanOracle oracle = noisy.oracle();
  const auto measure = oracle.measure;
  oracle.measure = [&](const SettingPoint& p) {
    PlanTrial trial = measure(p);
    // Two pixels of opposite noise for each that there is; all three together keep the mean square, and add the noise.
    const size_t pixels = trial.difference.size();
    for (double& d : trial.difference) d *= std::sqrt(3.0);
    for (size_t i = 0; i < pixels; ++i)
      for (const double sign : {-1.0, 1.0}) trial.difference.push_back(sign * std::sqrt(1.5 * noise));
    return trial;
  };
  oracle.noise = noise;
  const PlanSearch with = search_plan(noisy.space, budget, oracle),
                   without = search_plan(world.space, budget, world.oracle());
  REQUIRE(with.best);
  REQUIRE(without.best);
  CHECK(with.best->point[resolution_axis] > 0);
  CHECK(with.best->point == without.best->point);
  CHECK(with.trials.size() == without.trials.size());
}

TEST_CASE("The next steps lie beside the plan, one value along one axis", "[plan]") {
  for (const double budget : {0.6, 0.4, 0.3, 0.2, 0.1}) {
    SyntheticWorld world;
    const PlanSearch search = search_plan(world.space, budget, world.oracle());
    CAPTURE(budget);
    REQUIRE(search.best);
    const SettingPoint& best = search.best->point;
    const auto apart = [&](const PlanTrial& other) {
      size_t axes = 0;
      for (size_t a = 0; a < setting_axes; ++a) axes += other.point[a] != best[a];
      return axes;
    };
    if (search.cheaper) {
      CHECK(apart(*search.cheaper) == 1);
      CHECK(world.cost(search.cheaper->point) < world.cost(best));
      CHECK(search.cheaper->rel_error > budget);  // else it would be the plan
    }
    REQUIRE(search.better);
    CHECK(apart(*search.better) == 1);
    CHECK(search.better->rel_error < search.best->rel_error);
    for (size_t a = 0; a < setting_axes; ++a) {
      SettingPoint up = best, down = best;
      // Of all steps upward that win anything the cheapest; of all downward that save anything the most accurate.
      if (++up[a] < world.space.size(a) && world.error(up) < 0.96 * search.best->rel_error)
        CHECK(world.cost(search.better->point) <= world.cost(up));
      if (best[a] == 0) continue;
      --down[a];
      if (!(world.cost(down) < world.cost(best))) continue;
      REQUIRE(search.cheaper);
      CHECK(search.cheaper->rel_error <= world.error(down));
    }
  }
}

TEST_CASE("A step upward that promises more than it holds is not offered", "[plan]") {
  size_t deceived = 0;
  for (const double budget : {0.4, 0.3, 0.2, 0.1, 0.05}) {
    SyntheticWorld world;
    const PlanSearch honest = search_plan(world.space, budget, world.oracle());
    CAPTURE(budget);
    REQUIRE(honest.better);
    if (honest.trials.back().point != honest.better->point) continue;  // was measured before: nothing is promised
    ++deceived;
    PlanOracle oracle = world.oracle();
    const auto measure = oracle.measure;
    oracle.measure = [&](const SettingPoint& p) {
      PlanTrial trial = measure(p);
      if (p == honest.better->point) trial.rel_error *= 3.0;
      return trial;
    };
    const PlanSearch search = search_plan(world.space, budget, oracle);
    REQUIRE(search.best);
    CHECK(search.best->point == honest.best->point);
    if (search.better) CHECK(search.better->rel_error < search.best->rel_error);
  }
  CHECK(deceived > 0);
}

TEST_CASE("A plan drops what the scene does not use", "[plan]") {
  const Scene open = point_light_over_plane();
  const Caster caster(open);
  const Visibility visibility = measure_visibility(open, caster);
  CHECK(visibility.hit_share == 0.0);
  SettingSpace space;
  CHECK(drop_unused(space, open, visibility, glm::vec3(0.0f)).size() == 3);
  CHECK(space.bounces == std::vector<std::optional<int>>{0});
  CHECK(space.cones.size() == 1);
  const Scene room = cornell_box(CornellLight::area);
  SettingSpace all;
  CHECK(drop_unused(all, room, measure_visibility(room, Caster(room)), glm::vec3(0.0f)).size() == 1);  // not specular
  CHECK(all.bounces.size() == SettingSpace{}.bounces.size());
  Scene shiny = room;
  shiny.materials[0].metallic = 1.0f;
  CHECK(drop_unused(all, shiny, measure_visibility(shiny, Caster(shiny)), glm::vec3(0.0f)).empty());
}
