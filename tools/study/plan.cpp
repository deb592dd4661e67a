#include "study/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/surface.h"

namespace voxref {

namespace {

enum PlanAxis : size_t { resolution_axis, bounce_axis, cone_axis, step_axis, storage_axis };

/// Every setting of one resolution.
std::vector<PlanPoint> points_at(const PlanSpace& space, size_t resolution) {
  std::vector<PlanPoint> points;
  PlanPoint point{};
  point[resolution_axis] = resolution;
  const auto each = [&](auto&& self, size_t axis) -> void {
    if (axis == PlanSpace::axes) return points.push_back(point);
    for (point[axis] = 0; point[axis] < space.size(axis); ++point[axis]) self(self, axis + 1);
  };
  each(each, bounce_axis);
  return points;
}

/// The search's state: what has been measured, each setting once.
class Search {
 public:
  Search(const PlanSpace& space, double budget, const PlanOracle& oracle)
      : space_(space), budget_(budget), oracle_(oracle) {}

  PlanSearch run() {
    for (const PlanPoint& point : points_at(space_, 0)) coarsest_[point] = measure(point).error;
    climb();
    choose();
    for (const PlanTrial& trial : result_.trials)
      if (!result_.closest || trial.error < result_.closest->error) result_.closest = trial;
    return result_;
  }

 private:
  PlanTrial measure(const PlanPoint& point) {
    for (const PlanTrial& trial : result_.trials)
      if (trial.point == point) return trial;
    result_.trials.push_back(oracle_.measure(point));
    return result_.trials.back();
  }

  /// Step 2.
  void climb() {
    const auto best = std::min_element(coarsest_.begin(), coarsest_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    PlanPoint point = best->first;
    gains_ = {0.0};
    double before = best->second;
    bool reached = before <= budget_;
    for (size_t r = 1; r < space_.size(resolution_axis); ++r) {
      point[resolution_axis] = r;
      const double error = measure(point).error;
      gains_.push_back(best->second * best->second - error * error);
      if (reached) return;
      reached = error <= budget_;
      const auto further = static_cast<double>(space_.size(resolution_axis) - 1 - r);
      if (!reached && error * std::pow(error / before, further) > slack * budget_) return;
      before = error;
    }
  }

  /// Step 3.
  void choose() {
    std::vector<PlanPoint> left;
    for (size_t r = 0; r < gains_.size(); ++r)
      for (PlanPoint point : points_at(space_, r)) {
        PlanPoint coarse = point;
        coarse[resolution_axis] = 0;
        const double error = coarsest_.at(coarse);
        if (error * error - gains_[r] <= slack * slack * budget_ * budget_) left.push_back(point);
      }
    std::stable_sort(left.begin(), left.end(),
                     [&](const PlanPoint& a, const PlanPoint& b) { return oracle_.cost(a) < oracle_.cost(b); });
    for (const PlanPoint& candidate : left) {
      const PlanTrial trial = measure(candidate);
      if (trial.error > budget_) continue;
      result_.best = trial;
      return;
    }
  }

  static constexpr double slack = 1.1;  // of predicted errors over the budget

  const PlanSpace& space_;
  double budget_;
  const PlanOracle& oracle_;
  std::map<PlanPoint, double> coarsest_;
  std::vector<double> gains_;  // per resolution, as far as the climb went
  PlanSearch result_;
};

bool has_specular(const Scene& scene) {
  const Materials materials(scene);
  for (uint32_t m = 0; m < scene.materials.size(); ++m) {
    const MaterialPoint* constant = materials.constant(m);
    if (!constant || constant->reflectance.has_specular()) return true;
  }
  return false;
}

}  // namespace

size_t PlanSpace::size(size_t axis) const {
  return std::array{resolutions.size(), bounces.size(), cones.size(), steps.size(), storages.size()}.at(axis);
}

Settings at(const PlanSpace& space, const PlanPoint& point, Settings settings) {
  settings.grid.resolution = space.resolutions[point[resolution_axis]];
  settings.bounce.count = space.bounces[point[bounce_axis]];
  settings.render.cone.diffuse = space.cones[point[cone_axis]];
  settings.render.cone.step = space.steps[point[step_axis]];
  settings.storage = space.storages[point[storage_axis]];
  return settings;
}

PlanSearch search_plan(const PlanSpace& space, double budget, const PlanOracle& oracle) {
  return Search(space, budget, oracle).run();
}

std::vector<std::string> drop_unused(PlanSpace& space, const Scene& scene, const Visibility& visibility,
                                     const glm::vec3& background) {
  std::vector<std::string> dropped;
  if (!has_specular(scene)) dropped.emplace_back("no surface is specular: no specular cones are traced");
  if (!scene.has_emission()) dropped.emplace_back("no surface emits: there is no volume of emission");
  if (visibility.hit_share > 0.0) return dropped;
  space.bounces = {0};
  space.cones.resize(1);
  space.steps.resize(1);
  dropped.emplace_back(
      background == glm::vec3(0.0f)
          ? "no surface sees another: no bounces, and the fewest cones, which find nothing"
          : "no surface sees another: no bounces, and the fewest cones, which see the background alone");
  return dropped;
}

}  // namespace voxref
