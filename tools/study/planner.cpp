#include "study/planner.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "reference/path.h"
#include "study/cone_runner.h"
#include "study/study_scenes.h"

namespace voxref {

namespace {

constexpr size_t image_bytes_per_pixel = 4 * 23;  // float32 channels of the cone tracer's image

/// Measures settings of one scene at small size, and predicts them at full size.
class Workbench {
 public:
  Workbench(const Scene& scene, const Caster& caster, const View& view, const Settings& base,
            const PlanOptions& options, const PlanSpace& space, const Visibility& visibility, const Progress& progress)
      : space_(space),
        base_(base),
        full_pixels_(size_t(view.width) * size_t(view.height)),
        small_(small_view(view, options.width)),
        measures_times_(!options.rates),
        runner_(scene, caster, small_, progress),
        cost_(visibility, options.rates.value_or(StageRates{})) {
    PathOptions path;
    path.spp = options.reference_spp;
    const Image truth = path_trace(scene, caster, small_, path, progress).image;
    indirect_ = compares_indirect(scene, view) && measured_path(truth, true).mean() > 0.0;
    truth_ = measured_path(truth, indirect_);
    // Counts voxels, and times the stages, before the first prediction.
    PlanPoint coarsest{};
    learn(coarsest, run(coarsest));
  }

  PlanTrial measure(const PlanPoint& point) {
    const ConeTraceResult result = run(point);
    learn(point, result);
    const Deviation d = deviation(measured_cone(result.image.image, indirect_), truth_);
    bytes_[point] = result.bytes.at("total");
    return {point, d.rel_error, d.rel_error_error};
  }

  double cost(const PlanPoint& point) const { return cost_.predict(settings(point), full_pixels_).total; }

  PlannedSetting planned(const PlanTrial& trial) const {
    return {settings(trial.point), trial.error, trial.error_bar, cost(trial.point),
            bytes_.at(trial.point) + image_bytes_per_pixel * full_pixels_};
  }

  bool indirect() const { return indirect_; }
  double spent() const { return measures_times_ ? runner_.spent() : modelled_; }

 private:
  static View small_view(View view, int width) {
    view.camera.aspect = float(view.width) / float(view.height);
    return sized(view, std::min(width, view.width));
  }
  Settings settings(const PlanPoint& point) const { return at(space_, point, base_); }
  size_t small_pixels() const { return size_t(small_.width) * size_t(small_.height); }
  ConeTraceResult run(const PlanPoint& point) { return runner_(settings(point)); }
  void learn(const PlanPoint& point, const ConeTraceResult& result) {
    cost_.learn(settings(point), result, small_pixels(), measures_times_);
    modelled_ += cost_.predict(settings(point), small_pixels()).total;
  }

  const PlanSpace& space_;
  const Settings& base_;
  size_t full_pixels_;
  View small_;
  bool measures_times_;
  ConeRunner runner_;
  CostModel cost_;
  bool indirect_ = false;
  Measured truth_;
  std::map<PlanPoint, size_t> bytes_;
  double modelled_ = 0.0;
};

Table trial_table(const PlanSearch& search, const PlanSpace& space, const Settings& base, const Workbench& bench) {
  Table table{"plan_trials",
              "What was measured, in this order; times are predicted for the full size",
              {{"voxels", ""},
               {"bounces", ""},
               {"cones", ""},
               {"step", ""},
               {"storage", ""},
               {"rel_error", ""},
               {"rel_error_stderr", ""},
               {"time", "s"}},
              {}};
  for (const PlanTrial& trial : search.trials) {
    const nlohmann::json s = to_json(at(space, trial.point, base));
    const nlohmann::json& bounces = s["bounce"]["count"];
    table.add({s["grid"]["resolution"].get<double>(), bounces.is_string() ? "auto" : bounces.dump(),
               s["cone"]["diffuse"].get<double>(), s["cone"]["step"].get<double>(), s["storage"].get<std::string>(),
               trial.error, trial.error_bar, bench.cost(trial.point)});
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
  PlanSpace space = options.space;
  plan.dropped = drop_unused(space, scene, visibility, view.background);
  Workbench bench(scene, caster, view, base, options, space, visibility, progress);
  plan.indirect = bench.indirect();

  const PlanSearch search = options.search(space, options.budget,
                                           {[&](const PlanPoint& point) { return bench.measure(point); },
                                            [&](const PlanPoint& point) { return bench.cost(point); }});
  plan.closest = bench.planned(*search.closest);
  if (search.best) {
    plan.best = bench.planned(*search.best);
    for (const PlanTrial& trial : search.trials) {
      const PlannedSetting other = bench.planned(trial);
      if (other.seconds < plan.best->seconds && (!plan.cheaper || other.error < plan.cheaper->error))
        plan.cheaper = other;
      if (other.error < plan.best->error && (!plan.better || other.seconds < plan.better->seconds)) plan.better = other;
    }
  }
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
