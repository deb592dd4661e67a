#include "study/plan_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "catch.h"
#include "study/plan_world.h"

using namespace voxref;

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

TEST_CASE("More cones that take less time than fewer are measured, once, and found", "[plan]") {
  // Learned rates may say so: each further number of cones costs 0.4 times the one before. Budgets that only finer
  // resolutions reach, several numbers of cones in one volume.
  for (const double budget : {0.1, 0.05}) {
    SyntheticWorld world;
    PlanOracle oracle = world.oracle();
    size_t asked = 0;
    oracle.cost = [&](const SettingPoint& p) {
      // 720 settings, each asked for a few times per measurement.
      if (++asked > 10'000'000) throw std::logic_error("the search goes round in circles");
      return world.cost(p) * std::pow(0.4, double(p[cone_axis]));
    };
    const PlanSearch search = search_plan(world.space, budget, oracle);
    asked = 0;
    double cheapest = std::numeric_limits<double>::infinity();
    for (const SettingPoint& p : all_points(world.space))
      if (world.error(p) <= budget) cheapest = std::min(cheapest, oracle.cost(p));
    CAPTURE(budget);
    REQUIRE(search.best);
    CHECK(search.best->point[cone_axis] + 1 == world.space.cones.size());
    CHECK(oracle.cost(search.best->point) <= 1.25 * cheapest);
    std::set<SettingPoint> different;
    for (const PlanTrial& trial : search.trials) different.insert(trial.point);
    CHECK(different.size() == search.trials.size());
  }
}

TEST_CASE("Of two values that make no difference the cheaper stays, be it the finer one", "[plan]") {
  for (const bool finer_is_cheaper : {false, true}) {
    SyntheticWorld world;
    PlanOracle oracle = world.oracle();
    const auto honest = [&world](SettingPoint p) {  // storage changes nothing but the cost
      p[storage_axis] = 1;
      return PlanTrial{p, world.error(p), 0.0, world.difference(p)};
    };
    oracle.measure = [&](const SettingPoint& p) {
      PlanTrial trial = honest(p);
      trial.point = p;
      return trial;
    };
    oracle.cost = [&](const SettingPoint& p) {
      const double by_storage = finer_is_cheaper ? -0.1 * double(p[storage_axis]) : 0.1 * double(p[storage_axis]);
      return world.cost(p) / (1.0 + 0.05 * double(p[storage_axis])) * (1.0 + by_storage);
    };
    const PlanSearch search = search_plan(world.space, 0.2, oracle);
    REQUIRE(search.best);
    CHECK(search.best->point[storage_axis] == (finer_is_cheaper ? world.space.storages.size() - 1 : 0));
  }
}

TEST_CASE("Images that are not finite are within no budget, and mislead no prediction", "[plan]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto spoilt = [&](SyntheticWorld& world, auto&& bad) {
    PlanOracle oracle = world.oracle();
    const auto measure = oracle.measure;
    oracle.measure = [=, &bad](const SettingPoint& p) {
      PlanTrial trial = measure(p);
      if (bad(p)) trial.rel_error = trial.rel_error_stderr = trial.difference[2] = nan, trial.nonfinite = 1;
      return trial;
    };
    return oracle;
  };
  for (const double budget : {0.6, 0.2, 0.1, 0.05}) {
    CAPTURE(budget);
    // All of them: nothing is reached, and hardly more is paid for than the coarsest resolution.
    SyntheticWorld world;
    const auto all = [](const SettingPoint&) { return true; };
    const PlanSearch none = search_plan(world.space, budget, spoilt(world, all));
    CHECK(!none.best);
    CHECK(none.closest);
    for (const PlanTrial& trial : none.trials) CHECK(trial.point[resolution_axis] <= 1);
    // 16 cones, at all resolutions or at the finer ones: the plan is the cheapest of the others, and what is not finite
    // promises nothing.
    for (const size_t from : {0, 1}) {
      SyntheticWorld partly;
      const auto bad = [from](const SettingPoint& p) { return p[cone_axis] == 3 && p[resolution_axis] >= from; };
      const PlanOracle oracle = spoilt(partly, bad);
      const PlanSearch search = search_plan(partly.space, budget, oracle);
      double cheapest = std::numeric_limits<double>::infinity(), everything = 0.0;
      for (const SettingPoint& p : all_points(partly.space)) {
        if (!bad(p) && partly.error(p) <= budget) cheapest = std::min(cheapest, partly.cost(p));
        everything += partly.effort(p);
      }
      REQUIRE(search.best);
      check_consistent(search, budget, oracle);
      CHECK(search.best->nonfinite == 0);
      CHECK(search.closest->nonfinite == 0);
      CHECK(partly.cost(search.best->point) <= 1.25 * cheapest);
      const auto wasted = std::count_if(search.trials.begin(), search.trials.end(), [](const PlanTrial& trial) {
        return trial.nonfinite > 0 && trial.point[resolution_axis] > 0;
      });
      CAPTURE(from, partly.spent, everything, wasted);
      // What the coarsest resolution did not warn of is found out once per volume, of which there are five.
      CHECK(wasted <= (from == 0 ? 0 : 5));
      CHECK(partly.spent <= 0.1 * everything);
    }
  }
}
