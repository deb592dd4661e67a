#include "study/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "settings_table.h"
#include "study/cone_runner.h"
#include "study/deviation.h"
#include "study/plan_unused.h"
#include "study/study_scenes.h"
#include "study/truth.h"

namespace voxref {

namespace {

View small_view(View view, int width) {
  view.camera.aspect = float(view.width) / float(view.height);
  return sized(view, std::min(width, view.width));
}

/// Measures settings of one scene at small size, and predicts them at full size.
class Workbench {
 public:
  Workbench(const Scene& scene, const Caster& caster, const View& view, const View& small, const Settings& base,
            const PlanOptions& options, const SettingSpace& space, const Truth& truth, const Progress& progress)
      : space_(space),
        base_(base),
        full_pixels_(size_t(view.width) * size_t(view.height)),
        small_pixels_(size_t(small.width) * size_t(small.height)),
        measures_times_(!options.rates),
        progress_(progress),
        runner_(scene, caster, small, progress),
        cost_(mean_sight(scene, caster), options.rates.value_or(StageRates{})),
        truth_(truth),
        mean_(truth.light.mean()) {
    // Counts voxels, and times the stages, before the first prediction.
    const ConeTraceResult first = runner_(settings({}));
    const StageSeconds ran = runner_.ran();
    for (int round = 0; measures_times_ && round < 3; ++round) {  // the median of three outlives one busy moment
      runner_(settings({}), sized(small, 1));
      cost_.learn_image(runner_.ran().cone_trace);
    }
    learn({}, first, ran);
  }

  PlanTrial measure(const SettingPoint& point) {
    progress_.check();
    const ConeTraceResult result = runner_(settings(point));
    learn(point, result, runner_.ran());
    const Measured cone = measured_cone(result.image.image, truth_.indirect);
    const Deviation d = deviation(cone, truth_.light);
    bytes_[point] = result.bytes.at("total");
    PlanTrial trial{point, d.rel_error(), d.rel_error_stderr(), {}, d.nonfinite};
    for (size_t i = 0; i < cone.value.size(); ++i)
      trial.difference.push_back(relative(cone.value[i] - truth_.light.value[i], mean_));
    return trial;
  }

  /// Mean variance of a trial's differences.
  double noise() const {
    double sum = 0.0;
    for (const double s : truth_.light.standard_error) sum += relative(s * s, mean_ * mean_);
    return sum / static_cast<double>(truth_.light.standard_error.size());
  }

  Settings settings(const SettingPoint& point) const { return at(space_, point, base_); }
  double cost(const SettingPoint& point) const { return cost_.predict(settings(point), full_pixels_).total; }

  PlannedSetting planned(const PlanTrial& trial) const {
    return {settings(trial.point),  trial.rel_error,
            trial.rel_error_stderr, trial.nonfinite,
            cost(trial.point),      bytes_.at(trial.point) + cone_image_bytes_per_pixel * full_pixels_};
  }

  double spent() const { return measures_times_ ? runner_.spent() : modelled_; }

 private:
  void learn(const SettingPoint& point, const ConeTraceResult& result, const StageSeconds& ran) {
    cost_.learn(settings(point), result, small_pixels_, measures_times_ ? ran : StageSeconds{});
    const StageSeconds seconds = cost_.predict(settings(point), small_pixels_);
    for (const auto stage : {&StageSeconds::voxelize, &StageSeconds::shade, &StageSeconds::bounce,
                             &StageSeconds::prepare, &StageSeconds::cone_trace})
      if (ran.*stage > 0.0) modelled_ += seconds.*stage;
  }

  const SettingSpace& space_;
  const Settings& base_;
  size_t full_pixels_, small_pixels_;
  bool measures_times_;
  Progress progress_;
  ConeRunner runner_;
  CostModel cost_;
  const Truth& truth_;
  double mean_;
  std::map<SettingPoint, size_t> bytes_;
  double modelled_ = 0.0;  // seconds that all of it would have taken by the rates that were given
};

Table trial_table(const PlanSearch& search, const Workbench& bench) {
  Table table{"plan_trials", "What was measured, in this order; times are predicted for the full size",
              setting_columns()};
  table.columns.insert(table.columns.end(),
                       {{"rel_error", ""}, {"rel_error_stderr", ""}, {"nonfinite", "pixels"}, {"time", "s"}});
  for (const PlanTrial& trial : search.trials) {
    std::vector<Cell> row = setting_cells(bench.settings(trial.point));
    row.insert(row.end(), {trial.rel_error, trial.rel_error_stderr, double(trial.nonfinite), bench.cost(trial.point)});
    table.add(std::move(row));
  }
  return table;
}

std::vector<std::string> not_finite(const PlanSearch& search, const Truth& truth) {
  std::vector<std::string> sentences;
  if (!truth.missing().empty()) sentences.push_back(truth.missing());
  size_t settings = 0, most = 0;
  for (const PlanTrial& trial : search.trials) settings += trial.nonfinite > 0, most = std::max(most, trial.nonfinite);
  if (settings > 0)
    sentences.push_back(
        fmt::format("images of {} of {} settings have pixels that are NaN or infinite, up to {}: they "
                    "have no error, and are within no budget",
                    settings, search.trials.size(), most));
  return sentences;
}

/// Every leaf of `json` that differs from the same leaf of `from`.
nlohmann::json difference(const nlohmann::json& json, const nlohmann::json& from) {
  nlohmann::json result = nlohmann::json::object();
  for (const auto& [key, value] : json.items()) {
    if (value == from.at(key)) continue;
    result[key] = value.is_object() ? difference(value, from.at(key)) : value;
  }
  return result;
}

}  // namespace

Plan make_plan(const Scene& scene, const Caster& caster, const View& view, const Settings& base,
               const PlanOptions& options, const Progress& progress) {
  Plan plan;
  const View small = small_view(view, options.width);
  PathOptions path;
  path.spp = options.reference_spp;
  const Truth truth = trace_truth(scene, caster, small, path, progress);
  plan.indirect = truth.indirect;
  plan.reference_seconds = truth.seconds;

  SettingSpace space = options.space;
  // Indirect light that paths found is proof that something is seen; without it (other light is compared) rays are.
  const bool sees = truth.indirect || view_sees_surfaces(scene, caster, small);
  plan.dropped = drop_unused(space, scene, sees, view.background);
  Workbench bench(scene, caster, view, small, base, options, space, truth, progress);

  const PlanSearch search =
      options.search(space, options.budget,
                     {[&](const SettingPoint& point) { return bench.measure(point); },
                      [&](const SettingPoint& point) { return bench.cost(point); }, bench.noise()});
  // From here on nothing is measured, and so costs are as the search left them.
  const auto planned = [&](const std::optional<PlanTrial>& trial) {
    return trial ? std::optional(bench.planned(*trial)) : std::nullopt;
  };
  plan.closest = bench.planned(*search.closest);
  plan.best = planned(search.best);
  plan.cheaper = planned(search.cheaper);
  plan.better = planned(search.better);
  plan.not_finite = not_finite(search, truth);
  plan.trials = trial_table(search, bench);
  plan.seconds = bench.spent();
  return plan;
}

nlohmann::json config(const Settings& settings) {
  nlohmann::json result = difference(to_json(settings), to_json(profile(settings.profile)));
  result["profile"] = settings.profile;
  return result;
}

std::vector<std::string> assignments(const Settings& settings) {
  const Settings from = profile(settings.profile);
  std::vector<std::string> result;
  for (const Parameter& parameter : parameters()) {
    const nlohmann::json value = parameter.get(settings);
    if (value == parameter.get(from)) continue;
    result.push_back(parameter.key + "=" + (value.is_string() ? value.get<std::string>() : value.dump()));
  }
  return result;
}

}  // namespace voxref
