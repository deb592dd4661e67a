#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "study/setting_space.h"

namespace voxref {

/// What was measured of a setting.
struct PlanTrial {
  SettingPoint point{};
  /// NaN where the image is not finite everywhere: within no budget, and nothing is predicted from it.
  double rel_error = 0, rel_error_stderr = 0;
  std::vector<double> difference{};  ///< from the truth per pixel, signed, over the truth's mean
  size_t nonfinite = 0;              ///< pixels of the compared light that are NaN or infinite
};

/// What the search needs to know of the scene.
struct PlanOracle {
  std::function<PlanTrial(const SettingPoint&)> measure;  ///< expensive
  /// Seconds at full size; cheap. What measurements teach may change it: the search ends with one state of it, after
  /// the last measurement, in which all that it found is cheapest, cheaper or dearer.
  std::function<double(const SettingPoint&)> cost;
  double noise = 0;  ///< mean variance of `difference`, which rel_error leaves out
};

struct PlanSearch {
  std::optional<PlanTrial> best;     ///< the cheapest of all trials within the budget; none: no setting reaches it
  std::optional<PlanTrial> closest;  ///< the most accurate one that was measured
  /// Of the settings beside the best, one value away along one axis: the one with the least predicted error of those
  /// that cost less ...
  std::optional<PlanTrial> cheaper;
  /// ... and the cheapest that is more accurate, of those that were predicted to be.
  std::optional<PlanTrial> better;
  std::vector<PlanTrial> trials;  ///< in the order in which they were measured
};

/// Finds the cheapest setting whose error is at most `budget` without measuring most of the space. Errors make up for
/// one another (bytes clamp light that wide cones have too much of; a bounce that is missing does too), so that no
/// parameter may be judged alone, and errors do not add up. Differences of images do, with their signs:
///
/// 1. At the coarsest resolution, where a volume costs least, values of storage and step that change the error by less
///    than a 25th and the image by less than half the budget, both of the cheapest setting and of the finest, are
///    dropped, the dearer of each two, and all that is left is measured.
/// 2. Any other setting is predicted: its image is that at the coarsest resolution plus what its resolution changed in
///    the image of the nearest setting that was measured at both. The cheapest that promises to be within 1.1 times the
///    budget is measured, with those of fewer cones in the same volume up to 1.3 times, and improves the predictions;
///    until none is left that would be cheaper than what was found. Where nothing promises or was found, resolutions
///    that were reached are searched up to 1.2 times the budget, and then the most promising setting of the next finer
///    one is measured, unless errors fall too slowly to come near the budget.
/// 3. The settings beside the best are predicted, with values that were not dropped, though the best may have one that
///    was, and `cheaper` and `better` measured; where that finds a better best, or changes what settings cost, from 2
///    again.
PlanSearch search_plan(const SettingSpace& space, double budget, const PlanOracle& oracle);

}  // namespace voxref
