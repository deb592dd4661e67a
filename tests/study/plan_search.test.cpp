#include "study/plan_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include "catch.h"

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

namespace {

/// What holds of every search under the costs that it ended with.
void check_consistent(const PlanSearch& search, double budget, const PlanOracle& oracle) {
  const auto cost = [&](const std::optional<PlanTrial>& trial) { return oracle.cost(trial->point); };
  for (const PlanTrial& trial : search.trials) {
    if (trial.rel_error <= budget) {
      REQUIRE(search.best);
      CHECK(cost(search.best) <= oracle.cost(trial.point));
    }
    CHECK(!(trial.rel_error < search.closest->rel_error));
  }
  if (search.best) CHECK(search.best->rel_error <= budget);
  if (search.cheaper) CHECK(cost(search.cheaper) < cost(search.best));
  if (search.cheaper) CHECK(!(search.cheaper->rel_error <= budget));  // else it would be the plan
  if (search.better) CHECK(cost(search.better) >= cost(search.best));
  if (search.better) CHECK(search.better->rel_error < search.best->rel_error);
}

}  // namespace

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
