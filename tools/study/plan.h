#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/cost_model.h"
#include "study/plan_search.h"
#include "study/table.h"

namespace voxref {

struct PlanOptions {
  /// The most that rel_error may be: the estimate itself, which is as likely too high as too low; its standard error
  /// stands beside it.
  double budget = 0.2;
  int width = 48;           ///< pixels of the images that are measured
  int reference_spp = 512;  ///< of the path-traced image that they are held against
  SettingSpace space;       ///< what is searched; an axis of one value is fixed
  PlanSearch (*search)(const SettingSpace&, double budget, const PlanOracle&) = search_plan;
  /// How fast this machine is, for decisions that do not depend on its clock; none: learned from the runs.
  std::optional<StageRates> rates;
};

/// A setting with its evidence, at the size that was asked for.
struct PlannedSetting {
  Settings settings;
  double rel_error = 0, rel_error_stderr = 0;  ///< measured at small size; NaN where the image is not finite
  size_t nonfinite = 0;                        ///< pixels that are NaN or infinite, at small size
  double seconds = 0;                          ///< predicted
  size_t bytes = 0;                            ///< of the volumes and the image; the volumes are measured
};

struct Plan {
  std::optional<PlannedSetting> best;             ///< none: nothing reaches the budget
  PlannedSetting closest;                         ///< the most accurate that was measured
  std::optional<PlannedSetting> cheaper, better;  ///< the next steps, see PlanSearch; none where there is none
  std::vector<std::string> dropped;               ///< what the scene does not use
  std::vector<std::string> not_finite;            ///< what was NaN or infinite, one sentence each
  bool indirect = false;                          ///< whether errors are of the indirect light alone
  Table trials;                                   ///< all that was measured, in that order
  double seconds = 0;            ///< that the measurements took, each stage as often as it ran; by `rates` where given
  double reference_seconds = 0;  ///< that the path-traced image took
};

/// Plans for one view of a scene. @param view the full size @param base where the other parameters come from
Plan make_plan(const Scene& scene, const Caster& caster, const View& view, const Settings& base,
               const PlanOptions& options, const Progress& progress = {});

/// The parameters in which `settings` differ from the profile that they start from: what `cone --config` reads.
nlohmann::json config(const Settings& settings);
/// The same but for the profile, as `cone --set` takes it: "key=value" each.
std::vector<std::string> assignments(const Settings& settings);

}  // namespace voxref
