#include "study/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scene/surface.h"

namespace voxref {

namespace {

// What a value may change and still be dropped: as a share of the error, and in the image as a share of the budget, for
// the coarsest resolution's own error may hide what counts at finer ones.
constexpr double irrelevant = 0.04, hidden = 0.5;
// How far predicted errors may be over the budget: of settings that are measured first; of those that are measured
// where nothing else is left; of those whose volume is there anyway, so that they cost little; and of the last
// resolution's, for the climb to be worth its cost.
constexpr double slack = 1.1, last_slack = 1.2, volume_slack = 1.3, hope = 1.7;

/// The search's state: what has been measured, each setting once, and what is left to choose from.
class Search {
 public:
  Search(const SettingSpace& space, double budget, const PlanOracle& oracle)
      : space_(space), budget_(budget), oracle_(oracle), kept_(all_points(space)) {}

  PlanSearch run() {
    drop_irrelevant(storage_axis);
    drop_irrelevant(step_axis);
    for (const SettingPoint& point : kept_)
      if (point[resolution_axis] == 0) measure(point);
    for (;;) {
      std::optional<SettingPoint> next = cheapest_promising(slack, space_.size(resolution_axis));
      if (!next && !best_) next = cheapest_promising(last_slack, climbed_.size());
      if (next)
        measure_volume(*next);
      else if (best_ || !climb())
        break;
    }
    result_.closest = *std::min_element(result_.trials.begin(), result_.trials.end(), more_accurate);
    if (best_) {
      result_.best = trial(*best_);
      look_beside(*result_.best);
    }
    return result_;
  }

 private:
  static bool more_accurate(const PlanTrial& a, const PlanTrial& b) { return a.rel_error < b.rel_error; }
  bool measured(const SettingPoint& point) const { return index_.count(point) > 0; }
  const PlanTrial& trial(const SettingPoint& point) const { return result_.trials[index_.at(point)]; }

  const PlanTrial& measure(const SettingPoint& point) {
    if (!measured(point)) {
      index_[point] = result_.trials.size();
      result_.trials.push_back(oracle_.measure(point));
      const bool cheapest = !best_ || oracle_.cost(point) < oracle_.cost(*best_);
      const double error = result_.trials.back().rel_error;
      if (error <= budget_ && cheapest) best_ = point;
      while (climbed_.size() <= point[resolution_axis]) climbed_.push_back(climbed_.empty() ? error : climbed_.back());
      for (size_t r = point[resolution_axis]; r < climbed_.size(); ++r) climbed_[r] = std::min(climbed_[r], error);
    }
    return trial(point);
  }

  static double rms_between(const PlanTrial& a, const PlanTrial& b) {
    double square = 0.0;
    for (size_t i = 0; i < a.difference.size(); ++i) {
      const double d = a.difference[i] - b.difference[i];
      square += d * d;
    }
    return std::sqrt(square / static_cast<double>(a.difference.size()));
  }

  /// Step 1: of two neighbouring values that make no difference the cheaper stays.
  void drop_irrelevant(size_t axis) {
    SettingPoint cheapest{}, finest{};
    for (size_t a = bounce_axis; a < setting_axes; ++a) finest[a] = space_.size(a) - 1;
    size_t before = 0;
    for (size_t value = 1; value < space_.size(axis); ++value) {
      bool matters = false;
      for (SettingPoint corner : {cheapest, finest}) {
        corner[axis] = before;
        const PlanTrial coarse = measure(corner);
        corner[axis] = value;
        const PlanTrial& fine = measure(corner);
        const double error = std::max(budget_, std::min(fine.rel_error, coarse.rel_error));
        matters = matters || std::abs(fine.rel_error - coarse.rel_error) > irrelevant * error ||
                  rms_between(fine, coarse) > hidden * budget_;
      }
      if (matters)
        before = value;
      else
        std::erase_if(kept_, [&](const SettingPoint& point) { return point[axis] == value; });
    }
  }

  /// Of the settings of the first `resolutions` that would be cheaper than what was found, the cheapest whose predicted
  /// error is at most `allowed` times the budget.
  std::optional<SettingPoint> cheapest_promising(double allowed, size_t resolutions) const {
    std::optional<SettingPoint> found = best_;
    for (const SettingPoint& point : kept_)
      if (point[resolution_axis] < resolutions && !measured(point) &&
          (!found || oracle_.cost(point) < oracle_.cost(*found)) && predict(point) <= allowed * budget_)
        found = point;
    return found == best_ ? std::nullopt : found;
  }

  /// Measures, at the next finer resolution, the setting that promises most. @returns false where there is none, or
  /// where the least error would not come near the budget if each further resolution won as much as the last did
  bool climb() {
    const size_t next = climbed_.size(), all = space_.size(resolution_axis);
    if (next == all) return false;
    const auto further = static_cast<double>(all - next);
    if (next > 1 && climbed_.back() * std::pow(climbed_.back() / climbed_[next - 2], further) > hope * budget_)
      return false;
    std::optional<SettingPoint> probe;
    for (const SettingPoint& point : kept_)
      if (point[resolution_axis] == next && (!probe || predict(point) < predict(*probe))) probe = point;
    measure(*probe);
    return true;
  }

  /// The setting, and before it those of fewer cones: where a volume is there, an image costs little.
  void measure_volume(const SettingPoint& wanted) {
    SettingPoint point = wanted;
    for (point[cone_axis] = 0; point[cone_axis] <= wanted[cone_axis]; ++point[cone_axis])
      if ((point == wanted || predict(point) <= volume_slack * budget_) && measure(point).rel_error <= budget_) return;
  }

  /// Of what was measured at the finest resolution up to that of `point`, above the coarsest, the setting that is the
  /// most like it: light that bounces, and how it is stored, change images more than cones do.
  const PlanTrial* most_similar(const SettingPoint& point) const {
    constexpr std::array<double, setting_axes> weight = {1e3, 4.0, 3.0, 1.0, 2.0};
    const PlanTrial* found = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlanTrial& other : result_.trials) {
      if (other.point[resolution_axis] == 0 || other.point[resolution_axis] > point[resolution_axis]) continue;
      double distance = 0.0;
      for (size_t a = 0; a < setting_axes; ++a)
        distance += weight[a] * std::abs(double(other.point[a]) - double(point[a]));
      if (distance < nearest) nearest = distance, found = &other;
    }
    return found;
  }

  /// The error that a setting will have; of one that was measured, the error that it has.
  double predict(const SettingPoint& point) const {
    if (measured(point)) return trial(point).rel_error;
    const auto coarse = [&](SettingPoint p) -> const PlanTrial& {
      p[resolution_axis] = 0;
      return trial(p);
    };
    const PlanTrial& own = coarse(point);
    const PlanTrial* fine = most_similar(point);
    if (!fine) return own.rel_error;
    const PlanTrial& its = coarse(fine->point);
    double square = 0.0;
    for (size_t i = 0; i < own.difference.size(); ++i) {
      const double d = own.difference[i] + fine->difference[i] - its.difference[i];
      square += d * d;
    }
    return std::sqrt(std::max(0.0, square / static_cast<double>(own.difference.size()) - oracle_.noise));
  }

  /// Step 3. A step goes to the next value that was not dropped.
  void look_beside(const PlanTrial& best) {
    std::vector<SettingPoint> down, up;
    for (size_t axis = 0; axis < setting_axes; ++axis) {
      std::optional<SettingPoint> below, above;
      for (const SettingPoint& point : kept_) {
        SettingPoint moved = best.point;
        moved[axis] = point[axis];
        if (moved != point) continue;
        if (point[axis] < best.point[axis] && (!below || point[axis] > (*below)[axis])) below = point;
        if (point[axis] > best.point[axis] && (!above || point[axis] < (*above)[axis])) above = point;
      }
      if (below && oracle_.cost(*below) < oracle_.cost(best.point)) down.push_back(*below);
      if (above) up.push_back(*above);
    }
    const auto by = [](auto value) { return [=](const auto& a, const auto& b) { return value(a) < value(b); }; };
    const auto predicted = [this](const SettingPoint& p) { return predict(p); };
    if (!down.empty()) result_.cheaper = measure(*std::min_element(down.begin(), down.end(), by(predicted)));
    std::sort(up.begin(), up.end(), by(oracle_.cost));
    for (const SettingPoint& point : up)
      if (predict(point) < best.rel_error && measure(point).rel_error < best.rel_error) {
        result_.better = trial(point);
        return;
      }
  }

  const SettingSpace& space_;
  double budget_;
  const PlanOracle& oracle_;
  std::vector<SettingPoint> kept_;
  std::map<SettingPoint, size_t> index_;  // of trials
  std::vector<double> climbed_;           // least errors up to each resolution, as far as any was measured
  std::optional<SettingPoint> best_;
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

PlanSearch search_plan(const SettingSpace& space, double budget, const PlanOracle& oracle) {
  return Search(space, budget, oracle).run();
}

std::vector<std::string> drop_unused(SettingSpace& space, const Scene& scene, const Visibility& visibility,
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
