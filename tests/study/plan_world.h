#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.h"
#include "study/plan_search.h"

namespace voxref {

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

/// What holds of every search under the costs that it ended with.
inline void check_consistent(const PlanSearch& search, double budget, const PlanOracle& oracle) {
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

}  // namespace voxref
