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

/// Finds the cheapest setting whose error is at most `budget` without measuring most of the space. Errors make up for
/// one another (bytes clamp light that wide cones have too much of; a bounce that is missing does too), so that no
/// parameter may be judged alone. But a volume of half the resolution costs a quarter and shows the same play:
///
/// 1. At the coarsest resolution every setting is measured: e_0.
/// 2. The best of them is measured at finer and finer resolutions: what its squared error loses, g_r = e_0^2 - e_r^2,
/// is
///    their gain. This ends one resolution after the budget is reached, or where the ratio of the last two errors, had
///    again by each further one, would not do.
/// 3. Those of all settings whose predicted error sqrt(e_0^2 - g_r) is at most 1.1 times the budget are measured,
/// cheapest
///    first. The first that is within is it.
PlanSearch search_plan(const PlanSpace& space, double budget, const PlanOracle& oracle);

/// Takes away what the scene cannot use, and says so in one line each: the bounces where no surface sees another, and
/// then all but the fewest cones.
std::vector<std::string> drop_unused(PlanSpace& space, const Scene& scene, const Visibility& visibility,
                                     const glm::vec3& background);

}  // namespace voxref
