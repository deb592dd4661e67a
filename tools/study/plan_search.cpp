#include "study/plan_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace voxref {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// What a value may change and still be dropped: as a share of the error, and in the image as a share of the budget, for
// the coarsest resolution's own error may hide what counts at finer ones.
constexpr double irrelevant = 0.04, hidden = 0.5;
// How far predicted errors may be over the budget: of settings that are measured first; of those that are measured
// where nothing else is left; of those whose volume is there anyway, so that they cost little; and of the last
// resolution's, for the climb to be worth its cost.
constexpr double slack = 1.1, last_slack = 1.2, volume_slack = 1.3, hope = 1.7;

/// The error, or infinity where there is none: what is not finite is worse than all else.
double comparable_error(const PlanTrial& trial) { return std::isnan(trial.rel_error) ? infinity : trial.rel_error; }

bool more_accurate(const PlanTrial& a, const PlanTrial& b) { return comparable_error(a) < comparable_error(b); }

double rms_between(const PlanTrial& a, const PlanTrial& b) {
  double square = 0.0;
  for (size_t i = 0; i < a.difference.size(); ++i) {
    const double d = a.difference[i] - b.difference[i];
    square += d * d;
  }
  return std::sqrt(square / static_cast<double>(a.difference.size()));
}

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
    // Each round but the last measures something, so that the last leaves costs as all that was found is judged by.
    for (bool changed = true; changed;) {
      while (advance()) {
      }
      const size_t before = result_.trials.size();
      look_beside();
      changed = result_.trials.size() > before;
    }
    result_.closest = *std::min_element(result_.trials.begin(), result_.trials.end(), more_accurate);
    return std::move(result_);
  }

 private:
  bool measured(const SettingPoint& point) const { return index_.count(point) > 0; }
  const PlanTrial& trial(const SettingPoint& point) const { return result_.trials[index_.at(point)]; }
  const PlanTrial& coarsest(SettingPoint point) const {
    point[resolution_axis] = 0;
    return trial(point);
  }

  const PlanTrial& measure(const SettingPoint& point) {
    if (!measured(point)) {
      index_[point] = result_.trials.size();
      result_.trials.push_back(oracle_.measure(point));
      const double error = comparable_error(result_.trials.back());
      while (climbed_.size() <= point[resolution_axis]) climbed_.push_back(climbed_.empty() ? error : climbed_.back());
      for (size_t r = point[resolution_axis]; r < climbed_.size(); ++r) climbed_[r] = std::min(climbed_[r], error);
    }
    return trial(point);
  }

  /// The cheapest trial within the budget, by what settings cost now; null: none.
  const PlanTrial* best() const {
    const PlanTrial* found = nullptr;
    double least = infinity;
    for (const PlanTrial& trial : result_.trials)
      if (trial.rel_error <= budget_)
        if (const double cost = oracle_.cost(trial.point); !found || cost < least) found = &trial, least = cost;
    return found;
  }

  /// Step 1: of two neighbouring values that make no difference the cheaper stays.
  void drop_irrelevant(size_t axis) {
    SettingPoint cheapest{}, finest{};
    for (size_t a = bounce_axis; a < setting_axes; ++a) finest[a] = space_.size(a) - 1;
    size_t stays = 0;
    for (size_t value = 1; value < space_.size(axis); ++value) {
      bool matters = false;
      double stays_cost = 1.0, value_cost = 1.0;  // products, so that both corners count alike
      for (SettingPoint corner : {cheapest, finest}) {
        corner[axis] = stays;
        const PlanTrial a = measure(corner);
        stays_cost *= oracle_.cost(corner);
        corner[axis] = value;
        const PlanTrial& b = measure(corner);
        value_cost *= oracle_.cost(corner);
        const double error = std::max(budget_, std::min(comparable_error(a), comparable_error(b)));
        const bool alike = std::abs(b.rel_error - a.rel_error) <= irrelevant * error &&
                           rms_between(b, a) <= hidden * budget_;  // not so where either is not finite
        matters = matters || !alike;
      }
      const size_t dropped = value_cost < stays_cost ? stays : value;
      if (!matters) std::erase_if(kept_, [&](const SettingPoint& point) { return point[axis] == dropped; });
      if (matters || dropped == stays) stays = value;
    }
  }

  /// Step 2: measures what promises most. @returns false where nothing does
  bool advance() {
    const PlanTrial* found = best();
    const double least = found ? oracle_.cost(found->point) : infinity;
    std::optional<SettingPoint> next = cheapest_promising(least, slack, space_.size(resolution_axis));
    if (!next && !found) next = cheapest_promising(least, last_slack, climbed_.size());
    if (!next) return !found && climb();
    measure_volume(*next);
    return true;
  }

  /// Of the settings of the first `resolutions` that were not measured and cost less than `cost`, the cheapest whose
  /// predicted error is at most `allowed` times the budget.
  std::optional<SettingPoint> cheapest_promising(double cost, double allowed, size_t resolutions) const {
    std::optional<SettingPoint> found;
    for (const SettingPoint& point : kept_) {
      if (point[resolution_axis] >= resolutions || measured(point)) continue;
      const double own = oracle_.cost(point);
      if (own < cost && predict(point) <= allowed * budget_) found = point, cost = own;
    }
    return found;
  }

  /// Measures, at the next finer resolution, the setting that promises most. @returns false where there is none, or
  /// where the least error would not come near the budget if each further resolution won as much as the last did
  bool climb() {
    const size_t next = climbed_.size(), all = space_.size(resolution_axis);
    if (next == all) return false;
    const auto further = static_cast<double>(all - next);
    if (next > 1 && !(climbed_.back() * std::pow(climbed_.back() / climbed_[next - 2], further) <= hope * budget_))
      return false;
    std::optional<SettingPoint> probe;
    for (const SettingPoint& point : kept_)
      if (point[resolution_axis] == next && (!probe || predict(point) < predict(*probe))) probe = point;
    measure(*probe);
    return true;
  }

  /// The setting, and before it those of fewer cones, until one is within the budget: where a volume is there, an image
  /// costs little. Those that were measured before say nothing new: though one were within the budget, the setting is
  /// wanted, as it is where learned costs have it that more cones take less time.
  void measure_volume(const SettingPoint& wanted) {
    SettingPoint point = wanted;
    for (point[cone_axis] = 0; point[cone_axis] < wanted[cone_axis]; ++point[cone_axis])
      if (!measured(point) && predict(point) <= volume_slack * budget_ && measure(point).rel_error <= budget_) return;
    measure(wanted);
  }

  /// Of what was measured at the finest resolution up to that of `point`, above the coarsest, the setting that is the
  /// most like it: light that bounces, and how it is stored, change images more than cones do.
  const PlanTrial* most_similar(const SettingPoint& point) const {
    constexpr std::array<double, setting_axes> weight = {1e3, 4.0, 3.0, 1.0, 2.0};
    const PlanTrial* found = nullptr;
    double nearest = infinity;
    for (const PlanTrial& other : result_.trials) {
      if (other.point[resolution_axis] == 0 || other.point[resolution_axis] > point[resolution_axis]) continue;
      if (!std::isfinite(other.rel_error) || !std::isfinite(coarsest(other.point).rel_error)) continue;
      double distance = 0.0;
      for (size_t a = 0; a < setting_axes; ++a)
        distance += weight[a] * std::abs(double(other.point[a]) - double(point[a]));
      if (distance < nearest) nearest = distance, found = &other;
    }
    return found;
  }

  /// The error that a setting will have, infinite where its coarsest image has none or no finite one; of one that was
  /// measured, the error that it has.
  double predict(const SettingPoint& point) const {
    if (measured(point)) return comparable_error(trial(point));
    const PlanTrial& own = coarsest(point);
    const PlanTrial* fine = most_similar(point);
    if (!fine || !std::isfinite(own.rel_error)) return comparable_error(own);
    const PlanTrial& its = coarsest(fine->point);
    double square = 0.0;
    for (size_t i = 0; i < own.difference.size(); ++i) {
      const double d = own.difference[i] + fine->difference[i] - its.difference[i];
      square += d * d;
    }
    return std::sqrt(std::max(0.0, square / static_cast<double>(own.difference.size()) - oracle_.noise));
  }

  /// The next values to either side, along each axis, that were not dropped. The point's own may have been: at a corner
  /// of the space it was measured all the same.
  std::vector<SettingPoint> beside(const SettingPoint& point) const {
    std::vector<SettingPoint> found;
    for (size_t axis = 0; axis < setting_axes; ++axis) {
      std::optional<SettingPoint> below, above;
      for (const SettingPoint& kept : kept_) {  // a product: every value that an axis kept is in it
        SettingPoint moved = point;
        moved[axis] = kept[axis];
        if (moved[axis] < point[axis] && (!below || moved[axis] > (*below)[axis])) below = moved;
        if (moved[axis] > point[axis] && (!above || moved[axis] < (*above)[axis])) above = moved;
      }
      for (const auto& neighbour : {below, above})
        if (neighbour) found.push_back(*neighbour);
    }
    return found;
  }

  /// Step 3: best, cheaper and better, of which all but the best may be new.
  void look_beside() {
    result_.best.reset(), result_.cheaper.reset(), result_.better.reset();
    const PlanTrial* found = best();
    if (!found) return;
    const PlanTrial best = *found;
    result_.best = best;
    std::vector<SettingPoint> near = beside(best.point);
    for (SettingPoint point : near) {  // beside a dropped value predictions lack the coarsest images
      point[resolution_axis] = 0;
      measure(point);
    }
    std::sort(near.begin(), near.end(), [&](auto& a, auto& b) { return oracle_.cost(a) < oracle_.cost(b); });
    std::optional<SettingPoint> cheaper;
    for (const SettingPoint& point : near)
      if (oracle_.cost(point) < oracle_.cost(best.point) && (!cheaper || predict(point) < predict(*cheaper)))
        cheaper = point;
    if (cheaper) result_.cheaper = measure(*cheaper);
    for (const SettingPoint& point : near)
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
  PlanSearch result_;
};

}  // namespace

PlanSearch search_plan(const SettingSpace& space, double budget, const PlanOracle& oracle) {
  return Search(space, budget, oracle).run();
}

}  // namespace voxref
