// The steps beside the plan: what its neighbours in the space cost and win.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "catch.h"
#include "study/plan_world.h"

using namespace voxref;

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

TEST_CASE("A step beside the plan that turns out cheaper and within the budget becomes the plan", "[plan]") {
  // One setting is better than predicted: the step down from what would be the plan without it.
  size_t found = 0;
  for (const double budget : {0.6, 0.4, 0.3, 0.2, 0.1, 0.05}) {
    SyntheticWorld world;
    const PlanSearch before = search_plan(world.space, budget, world.oracle());
    CAPTURE(budget);
    if (!before.cheaper) continue;
    const SettingPoint lucky = before.cheaper->point;
    PlanOracle oracle = world.oracle();
    const auto measure = oracle.measure;
    oracle.measure = [&](const SettingPoint& p) {
      PlanTrial trial = measure(p);
      if (p == lucky) trial.rel_error = 0.5 * budget;
      return trial;
    };
    const PlanSearch search = search_plan(world.space, budget, oracle);
    check_consistent(search, budget, oracle);
    CHECK(oracle.cost(search.best->point) <= oracle.cost(lucky));
    found += search.best->point == lucky;
  }
  CHECK(found > 0);
}

TEST_CASE("Plan, cheaper, better and closest agree under the costs that the last measurement left", "[plan]") {
  // Each measurement changes what settings cost, by up to a factor of 3, as learning in busy moments does.
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const double budget : {0.4, 0.2, 0.1, 0.03}) {
      SyntheticWorld world;
      std::mt19937 random(seed);
      std::map<std::pair<size_t, size_t>, double> factors;  // by resolution and cones
      PlanOracle oracle = world.oracle();
      oracle.cost = [&](const SettingPoint& p) {
        const auto factor = factors.find({p[resolution_axis], p[cone_axis]});
        return world.cost(p) * (factor == factors.end() ? 1.0 : factor->second);
      };
      const auto measure = oracle.measure;
      oracle.measure = [&](const SettingPoint& p) {
        factors[{p[resolution_axis], p[cone_axis]}] = std::exp(std::uniform_real_distribution<>(0.0, 1.1)(random));
        return measure(p);
      };
      const PlanSearch search = search_plan(world.space, budget, oracle);
      CAPTURE(seed, budget);
      check_consistent(search, budget, oracle);
    }
}

TEST_CASE("A plan of a value that was dropped has next steps: its neighbours are of the values that were not",
          "[plan]") {
  // Storage changes no image. Its second value is the cheapest in the coarsest corner, which is the plan, but over both
  // corners the dearest, and so dropped.
  constexpr double budget = 5.0;
  SyntheticWorld world;
  PlanOracle oracle = world.oracle();
  oracle.measure = [&](const SettingPoint& p) {
    SettingPoint same = p;
    same[storage_axis] = 1;
    return PlanTrial{p, world.error(same), 0.0, world.difference(same)};
  };
  const SettingPoint corner{0, 0, 1, 0, 0};
  oracle.cost = [&](SettingPoint p) {
    const double by_storage = p == corner ? 0.9 : p[storage_axis] == 1 ? 1.5 : 1.0 + 0.1 * double(p[storage_axis]);
    p[storage_axis] = 0;
    return by_storage * world.cost(p);
  };
  const PlanSearch search = search_plan(world.space, budget, oracle);
  check_consistent(search, budget, oracle);
  REQUIRE(search.best);
  REQUIRE(search.best->point == corner);
  REQUIRE(search.better);
  for (const size_t axis : {resolution_axis, bounce_axis, cone_axis}) {
    SettingPoint up = corner;
    ++up[axis];
    CHECK(oracle.cost(search.better->point) <= oracle.cost(up));
  }
}
