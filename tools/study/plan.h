#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/cost_model.h"
#include "study/deviation.h"

namespace voxref {

/// The values that a search may choose from, coarse to fine; their product is the space.
struct PlanSpace {
  std::vector<int> resolutions = {32, 64, 128, 256};
  std::vector<std::optional<int>> bounces = {0, 1, 2, 3, std::nullopt};  ///< none: auto
  std::vector<int> cones = {4, 6, 9, 16, 32, 64};
  std::vector<float> steps = {1.0f, 0.5f};
  std::vector<Storage> storages = {Storage::unorm8, Storage::float16, Storage::float32};

  static constexpr size_t axes = 5;
  size_t size(size_t axis) const;
};

/// A setting of the space: an index per axis, in the order of PlanSpace's members.
using PlanPoint = std::array<size_t, PlanSpace::axes>;

/// `base` with the point's values.
Settings at(const PlanSpace& space, const PlanPoint& point, Settings base);

/// What was measured of a setting.
struct PlanTrial {
  PlanPoint point{};
  double error = 0;      ///< relative
  double error_bar = 0;  ///< one standard error
};

/// What the search needs to know of the scene.
struct PlanOracle {
  std::function<PlanTrial(const PlanPoint&)> measure;  ///< expensive
  std::function<double(const PlanPoint&)> cost;        ///< seconds at full size; cheap
};

struct PlanSearch {
  std::optional<PlanTrial> best;     ///< the cheapest within the budget; none: no setting reaches it
  std::optional<PlanTrial> closest;  ///< the most accurate one that was measured
  std::vector<PlanTrial> trials;     ///< in the order in which they were measured
};

/// Finds the cheapest setting whose error is at most `budget`, in three steps that leave most of the space untouched.
/// Cones, step and storage err less as they are finer; bounces need not, since light that is missing may make up for
/// light that is too much.
///
/// 1. With cones, step and storage at their finest, the resolution climbs until the budget is reached with some number
///    of bounces; it is given up where twice the last gain, or a tenth of the error, had again by every further step,
///    would not do.
/// 2. At that resolution and with the bounces that err least, cones, step and storage alone are made coarser, until
/// what
///    one adds to the error, e_a^2 = e^2 - e_finest^2, is by itself beyond the budget; coarser values are dropped.
/// 3. The settings that are left, at that resolution and the next, are measured cheapest first, those left out whose
///    predicted error sqrt(e_bounces^2 + sum e_a^2) is beyond the budget by more than a tenth. The first within is it.
PlanSearch search_plan(const PlanSpace& space, double budget, const PlanOracle& oracle);

/// Takes away what the scene cannot use, and says so in one line each: the bounces where no surface sees another, and
/// then all but the fewest cones.
std::vector<std::string> drop_unused(PlanSpace& space, const Scene& scene, const Visibility& visibility,
                                     const glm::vec3& background);

}  // namespace voxref
