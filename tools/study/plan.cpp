#include "study/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/surface.h"

namespace voxref {

namespace {

enum PlanAxis : size_t { resolution_axis, bounce_axis, cone_axis, step_axis, storage_axis };

PlanPoint finest(const PlanSpace& space) {
  PlanPoint point{};
  for (size_t a = 0; a < PlanSpace::axes; ++a) point[a] = space.size(a) - 1;
  return point;
}

/// The search's state: what has been measured, each setting once.
class Search {
 public:
  Search(const PlanSpace& space, double budget, const PlanOracle& oracle)
      : space_(space), budget_(budget), oracle_(oracle) {
    for (size_t a = 0; a < PlanSpace::axes; ++a) added_[a].assign(space.size(a), infinite);
    bounce_errors_.assign(space.size(bounce_axis), infinite);
  }

  PlanSearch run() {
    if (const std::optional<size_t> reached = climb()) {
      probe(*reached);
      choose(*reached);
    }
    for (const PlanTrial& trial : result_.trials)
      if (!result_.closest || trial.error < result_.closest->error) result_.closest = trial;
    return result_;
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  PlanTrial measure(const PlanPoint& point) {
    for (const PlanTrial& trial : result_.trials)
      if (trial.point == point) return trial;
    result_.trials.push_back(oracle_.measure(point));
    return result_.trials.back();
  }

  /// Step 1. @return the index of the resolution that reaches the budget
  std::optional<size_t> climb() {
    PlanPoint point = finest(space_);
    double before = infinite;
    for (size_t r = 0; r < space_.size(resolution_axis); ++r) {
      point[resolution_axis] = r;
      double least = infinite;
      for (size_t b = 0; b < space_.size(bounce_axis); ++b) {
        point[bounce_axis] = b;
        bounce_errors_[b] = measure(point).error;
        if (bounce_errors_[b] < least) best_bounces_ = b;
        least = std::min(least, bounce_errors_[b]);
      }
      if (least <= budget_) return r;
      const double gain = std::max(2.0 * (before - least), 0.1 * least);
      const auto further = static_cast<double>(space_.size(resolution_axis) - 1 - r);
      if (before < infinite && least - gain * further > budget_) return std::nullopt;
      before = least;
    }
    return std::nullopt;
  }

  /// Step 2.
  void probe(size_t resolution) {
    const double least = bounce_errors_[best_bounces_];
    for (size_t a = cone_axis; a < PlanSpace::axes; ++a) {
      PlanPoint point = finest(space_);
      point[resolution_axis] = resolution;
      point[bounce_axis] = best_bounces_;
      added_[a].back() = 0.0;
      for (size_t i = space_.size(a) - 1; i-- > 0;) {
        point[a] = i;
        const double error = measure(point).error;
        const double added = std::max(0.0, error * error - least * least);
        if (added > budget_ * budget_) break;
        added_[a][i] = added;
      }
    }
  }

  double predicted(const PlanPoint& point) const {
    double square = bounce_errors_[point[bounce_axis]] * bounce_errors_[point[bounce_axis]];
    for (size_t a = cone_axis; a < PlanSpace::axes; ++a) square += added_[a][point[a]];
    return std::sqrt(square);
  }

  /// Step 3.
  void choose(size_t resolution) {
    constexpr double slack = 1.1;
    std::vector<PlanPoint> left;
    PlanPoint point{};
    const auto each = [&](auto&& self, size_t axis) -> void {
      if (axis == PlanSpace::axes) {
        if (predicted(point) <= slack * budget_) left.push_back(point);
        return;
      }
      for (point[axis] = 0; point[axis] < space_.size(axis); ++point[axis]) self(self, axis + 1);
    };
    const size_t last = std::min(resolution + 1, space_.size(resolution_axis) - 1);
    for (point[resolution_axis] = resolution; point[resolution_axis] <= last; ++point[resolution_axis])
      each(each, bounce_axis);
    std::stable_sort(left.begin(), left.end(),
                     [&](const PlanPoint& a, const PlanPoint& b) { return oracle_.cost(a) < oracle_.cost(b); });
    for (const PlanPoint& candidate : left) {
      const PlanTrial trial = measure(candidate);
      if (trial.error > budget_) continue;
      result_.best = trial;
      return;
    }
  }

  const PlanSpace& space_;
  double budget_;
  const PlanOracle& oracle_;
  std::vector<double> bounce_errors_;  // at the resolution that was looked at last, the other axes at their finest
  size_t best_bounces_ = 0;
  std::array<std::vector<double>, PlanSpace::axes> added_;  // to the square of the error, per axis and value
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
