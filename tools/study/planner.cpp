#include "study/planner.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "reference/path.h"
#include "study/cone_runner.h"
#include "study/deviation.h"
#include "study/study_scenes.h"

namespace voxref {

namespace {

/// Measures settings of one scene at small size, and predicts them at full size.
class Workbench {
 public:
  Workbench(const Scene& scene, const Caster& caster, const View& view, const Settings& base,
            const PlanOptions& options, const SettingSpace& space, const Visibility& visibility,
            const Progress& progress)
      : space_(space),
        base_(base),
        full_pixels_(size_t(view.width) * size_t(view.height)),
        small_(small_view(view, options.width)),
        measures_times_(!options.rates),
        runner_(scene, caster, small_, progress),
        cost_(visibility, options.rates.value_or(StageRates{})) {
    PathOptions path;
    path.spp = options.reference_spp;
    const PathResult truth = path_trace(scene, caster, small_, path, progress);
    if (truth.interrupted) throw Interrupted();
    indirect_ = has_indirect_to_compare(scene, view, truth.image);
    truth_ = measured_path(truth.image, indirect_);
    mean_ = truth_.mean();
    // Counts voxels, and times the stages, before the first prediction.
    SettingPoint coarsest{};
    learn(coarsest, run(coarsest));
  }

  PlanTrial measure(const SettingPoint& point) {
    const ConeTraceResult result = run(point);
    learn(point, result);
    const Measured cone = measured_cone(result.image.image, indirect_);
    const Deviation d = deviation(cone, truth_);
    bytes_[point] = result.bytes.at("total");
    PlanTrial trial{point, d.rel_error(), d.rel_error_stderr()};
    for (size_t i = 0; i < cone.value.size(); ++i)
      trial.difference.push_back(relative(cone.value[i] - truth_.value[i], mean_));
    return trial;
  }

  /// Mean variance of a trial's differences.
  double noise() const {
    double sum = 0.0;
    for (const double s : truth_.standard_error) sum += relative(s * s, mean_ * mean_);
    return sum / static_cast<double>(truth_.standard_error.size());
  }

  double cost(const SettingPoint& point) const { return cost_.predict(settings(point), full_pixels_).total; }

  PlannedSetting planned(const PlanTrial& trial) const {
    return {settings(trial.point), trial.rel_error, trial.rel_error_stderr, cost(trial.point),
            bytes_.at(trial.point) + cone_image_bytes_per_pixel * full_pixels_};
  }

  bool indirect() const { return indirect_; }
  double spent() const { return measures_times_ ? runner_.spent() : modelled_; }

 private:
  static View small_view(View view, int width) {
    view.camera.aspect = float(view.width) / float(view.height);
    return sized(view, std::min(width, view.width));
  }
  /// Black against black is no error.
  static double relative(double value, double unit) { return value == 0.0 ? 0.0 : value / unit; }
  Settings settings(const SettingPoint& point) const { return at(space_, point, base_); }
  size_t small_pixels() const { return size_t(small_.width) * size_t(small_.height); }
  ConeTraceResult run(const SettingPoint& point) { return runner_(settings(point)); }
  void learn(const SettingPoint& point, const ConeTraceResult& result) {
    cost_.learn(settings(point), result, small_pixels(), measures_times_);
    // As the runner does it: settings that differ in nothing but the image's cones share the volume.
    const StageSeconds seconds = cost_.predict(settings(point), small_pixels());
    SettingPoint volume = point;
    volume[cone_axis] = 0;
    modelled_ += volume == last_volume_ ? seconds.cone_trace : seconds.total;
    last_volume_ = volume;
  }

  const SettingSpace& space_;
  const Settings& base_;
  size_t full_pixels_;
  View small_;
  bool measures_times_;
  ConeRunner runner_;
  CostModel cost_;
  bool indirect_ = false;
  Measured truth_;
  double mean_ = 0.0;
  std::map<SettingPoint, size_t> bytes_;
  std::optional<SettingPoint> last_volume_;
  double modelled_ = 0.0;
};

Table trial_table(const PlanSearch& search, const SettingSpace& space, const Settings& base, const Workbench& bench) {
  Table table{"plan_trials", "What was measured, in this order; times are predicted for the full size",
              setting_columns()};
  table.columns.insert(table.columns.end(), {{"rel_error", ""}, {"rel_error_stderr", ""}, {"time", "s"}});
  for (const PlanTrial& trial : search.trials) {
    std::vector<Cell> row = setting_cells(at(space, trial.point, base));
    row.insert(row.end(), {trial.rel_error, trial.rel_error_stderr, bench.cost(trial.point)});
    table.add(std::move(row));
  }
  return table;
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
  const Visibility visibility = measure_visibility(scene, caster);
  SettingSpace space = options.space;
  plan.dropped = drop_unused(space, scene, visibility, view.background);
  Workbench bench(scene, caster, view, base, options, space, visibility, progress);
  plan.indirect = bench.indirect();

  const PlanSearch search =
      options.search(space, options.budget,
                     {[&](const SettingPoint& point) { return bench.measure(point); },
                      [&](const SettingPoint& point) { return bench.cost(point); }, bench.noise()});
  const auto planned = [&](const std::optional<PlanTrial>& trial) {
    return trial ? std::optional(bench.planned(*trial)) : std::nullopt;
  };
  plan.closest = bench.planned(*search.closest);
  plan.best = planned(search.best);
  plan.cheaper = planned(search.cheaper);
  plan.better = planned(search.better);
  plan.trials = trial_table(search, space, base, bench);
  plan.seconds = bench.spent();
  return plan;
}

nlohmann::json config(const Settings& settings) {
  nlohmann::json result = difference(to_json(settings), to_json(profile(settings.profile)));
  result["profile"] = settings.profile;
  return result;
}

std::string assignments(const Settings& settings) {
  nlohmann::json differing = config(settings);
  differing.erase("profile");
  const nlohmann::json flat = differing.flatten();
  std::string text = "--profile " + settings.profile;
  for (const auto& [pointer, value] : flat.items()) {
    std::string key = pointer.substr(1);
    std::replace(key.begin(), key.end(), '/', '.');
    text += " --set " + key + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

}  // namespace voxref
