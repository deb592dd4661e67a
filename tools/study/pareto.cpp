// Speed against accuracy: relative error of the indirect light over time, for the cone tracer's settings and for the
// path tracer's samples.
#include "study/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include "compare/statistics.h"
#include "study/cone_runner.h"
#include "study/deviation.h"
#include "study/pareto_chart.h"
#include "study/study_scenes.h"
#include "study/truth.h"

namespace voxref {

namespace {

constexpr double significance = 0.05;  // outside of 95 % confidence limits
constexpr double normal_limit = 1.96;  // standard errors to that; the noise of thousands of pixels adds to a normal one

struct Setup {
  const StudyScene& scene;
  View view;
  Caster caster;
  Truth truth{};
};

Setup make_setup(const StudyScene& scene, const ParetoGrid& grid, const Progress& progress) {
  Setup setup{scene, sized(scene.view, grid.width), Caster(scene.scene)};
  PathOptions options;
  options.spp = grid.reference_spp;
  setup.truth = trace_truth(scene.scene, setup.caster, setup.view, options, progress);
  return setup;
}

std::vector<Column> measured_columns() {
  return {{"time", "s"},     {"time_least", "s"},   {"time_greatest", "s"},
          {"rel_error", ""}, {"rel_error_low", ""}, {"rel_error_high", ""}};
}

std::vector<Cell> measured_cells(const Spread& time, double error, const Interval& limits) {
  return {time.median, time.least, time.greatest, error, limits.low, limits.high};
}

void append(std::vector<Cell>& row, const std::vector<Cell>& more) { row.insert(row.end(), more.begin(), more.end()); }

/// The seconds that each setting took, per round; one round after another, so that a busy spell does not hit a setting
/// in all of them; busy spells matter little to what takes long. @param first is told every result of the first round
template <class First>
std::vector<std::vector<double>> time_settings(const Setup& setup, const ParetoGrid& grid, const Progress& progress,
                                               const First& first) {
  const std::vector<SettingPoint> points = all_points(grid.space);
  std::vector<std::vector<double>> seconds(points.size());
  size_t begun = 0;
  Progress stages = progress;
  if (progress.report)
    stages.report = [&](std::string_view stage, double fraction) {
      progress(fmt::format("setting {} of {}, {}", begun, points.size(), stage), fraction);
    };
  for (int round = 0; round < grid.rounds; ++round) {
    ConeRunner runner(setup.scene.scene, setup.caster, setup.view, stages);
    for (size_t i = 0; i < points.size(); ++i) {
      begun = i + 1;
      progress.check();
      if (round > 0 && seconds[i][0] > grid.long_enough) continue;
      const Settings settings = at(grid.space, points[i], {});
      const ConeTraceResult result = runner(settings);
      seconds[i].push_back(result.seconds.total);
      if (round == 0) first(settings, result);
    }
  }
  return seconds;
}

Table cone_table(const Setup& setup, const ParetoGrid& grid, const Progress& progress) {
  Table table{"pareto_" + setup.scene.name + "_cones",
              "Cone tracer: every setting with its error and the seconds of all its stages", setting_columns()};
  for (const Column& column : measured_columns()) table.columns.push_back(column);
  table.columns.insert(
      table.columns.end(),
      {{"rel_bias", ""}, {"nonfinite", "pixels"}, {"memory", "MiB"}, {"rounds", ""}, {"frontier", ""}});
  struct Found {
    Settings settings;
    Deviation deviation;
    double bytes;
  };
  std::vector<Found> found;
  const auto seconds =
      time_settings(setup, grid, progress, [&](const Settings& settings, const ConeTraceResult& result) {
        found.push_back({settings,
                         deviation(measured_cone(result.image.image, setup.truth.indirect), setup.truth.light),
                         double(result.bytes.at("total"))});
      });
  for (size_t i = 0; i < found.size(); ++i) {
    const Deviation& d = found[i].deviation;
    std::vector<Cell> row = setting_cells(found[i].settings);
    append(row, measured_cells(spread(seconds[i]), d.rel_error(),
                               {d.square.root(-normal_limit), d.square.root(normal_limit)}));
    append(row,
           {d.bias, double(d.nonfinite), std::ldexp(found[i].bytes, -20), double(seconds[i].size()), std::string()});
    table.add(std::move(row));
  }
  return table;
}

/// Error and time of images that are all the path tracer's, over independent seeds; the noise is the error.
/// @param missing gets a sentence on the paths that are missing in them; stays empty where none is
Table path_table(const Setup& setup, const ParetoGrid& grid, const Progress& progress, std::string& missing) {
  uint64_t all_nonfinite = 0;
  std::string first;
  Table table{"pareto_" + setup.scene.name + "_paths",
              fmt::format("Path tracer: mean error of {} seeds", grid.seeds),
              {{"samples", ""}}};
  for (const Column& column : measured_columns()) table.columns.push_back(column);
  table.columns.push_back({"nonfinite", "paths"});
  for (int spp = 1; spp <= grid.most_spp; spp *= 2) {
    std::vector<double> seconds, errors;
    uint64_t nonfinite = 0;
    for (int seed = 1; seed <= grid.seeds; ++seed) {
      PathOptions options;
      options.spp = spp;
      options.randomizations = 1;
      options.seed = static_cast<uint64_t>(seed);  // the truth has seed 0
      const PathResult result = trace_paths(setup.scene.scene, setup.caster, setup.view, options, progress);
      Measured image = measured_path(result.image, setup.truth.indirect);
      image.standard_error.assign(image.value.size(), 0.0);
      errors.push_back(deviation(image, setup.truth.light).rel_error());
      seconds.push_back(result.seconds);
      nonfinite += result.nonfinite;
      if (first.empty() && result.nonfinite > 0) first = fmt::format("{}, seed {}", result.first_nonfinite, seed);
    }
    all_nonfinite += nonfinite;
    const Estimate error = estimate(errors);
    const double limit = student_quantile(significance, error.freedom) * error.error;
    std::vector<Cell> row = {double(spp)};
    append(row, measured_cells(spread(seconds), error.mean, {std::max(0.0, error.mean - limit), error.mean + limit}));
    row.emplace_back(double(nonfinite));
    table.add(std::move(row));
  }
  if (all_nonfinite > 0)
    missing = fmt::format(
        "{} contributions to the path tracer's images of {} seeds are NaN or infinite and left out, the first at {}",
        all_nonfinite, grid.seeds, first);
  return table;
}

std::vector<Tradeoff> tradeoffs(const Table& table) {
  std::vector<Tradeoff> points;
  for (size_t i = 0; i < table.rows.size(); ++i)
    points.push_back({table.number(i, "time"), table.number(i, "rel_error")});
  return points;
}

/// Says of which settings the images have no error, and whether the truth or the path tracer's other images lack paths;
/// empty where all is finite. @param missing see path_table
std::string not_finite(const Table& cones, const Truth& truth, const std::string& missing) {
  std::string text;
  for (const std::string& sentence : {truth.missing(), missing})
    if (!sentence.empty()) text += "\n\n" + sentence + ".";
  size_t settings = 0;
  double most = 0.0;
  for (size_t i = 0; i < cones.rows.size(); ++i) {
    settings += cones.number(i, "nonfinite") > 0.0;
    most = std::max(most, cones.number(i, "nonfinite"));
  }
  if (settings == 0) return text;
  return text + fmt::format(
                    "\n\nImages of {} settings have pixels that are NaN or infinite, up to {}: they have no "
                    "error, and no place on the frontier.",
                    settings, most);
}

std::string findings(const Table& cones, const Table& paths, std::span<const size_t> frontier) {
  std::string text =
      "Error: RMS difference of luminance over the mean of the path-traced light, with the noise of the truth removed "
      "and 95 % confidence limits. Time: of all stages, booked to every setting that uses them, for the path tracer of "
      "its render loop; the median, and the least and the greatest measured on this machine, each setting once in a "
      "round (column rounds). Frontier: no other setting is both as quick and as accurate.\n\n";
  if (frontier.empty()) return text + "No setting has an image that is finite everywhere, and so an error.";
  const size_t best = frontier.back();
  const double error = cones.number(best, "rel_error");
  text += fmt::format("The most accurate of {} settings is {:.1f} % off in {:.3g} s.", cones.rows.size(), 100.0 * error,
                      cones.number(best, "time"));
  for (size_t i = 0; i < paths.rows.size(); ++i)
    if (paths.number(i, "rel_error") <= error)
      return text + fmt::format(" The path tracer is as near with {} samples, in {:.3g} s.", paths.number(i, "samples"),
                                paths.number(i, "time"));
  return text + fmt::format(" The path tracer is not as near with {} samples.",
                            paths.number(paths.rows.size() - 1, "samples"));
}

}  // namespace

std::vector<size_t> pareto_frontier(std::span<const Tradeoff> points) {
  std::vector<size_t> order(points.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::pair(points[a].seconds, points[a].error) < std::pair(points[b].seconds, points[b].error);
  });
  std::vector<size_t> frontier;
  for (const size_t i : order)
    if (!std::isnan(points[i].error) && (frontier.empty() || points[i].error < points[frontier.back()].error))
      frontier.push_back(i);
  return frontier;
}

Section pareto_section(const StudyScene& scene, const ParetoGrid& grid, const Progress& progress) {
  return timed_section(scene.name, [&](Section& section) {
    const Setup setup = make_setup(scene, grid, progress);
    Table cones = cone_table(setup, grid, progress);
    const std::vector<size_t> frontier = pareto_frontier(tradeoffs(cones));
    for (const size_t i : frontier) cones.rows[i].back() = "yes";
    std::string missing;
    Table paths = path_table(setup, grid, progress, missing);
    section.text = findings(cones, paths, frontier) + not_finite(cones, setup.truth, missing);
    section.charts.push_back(pareto_chart(scene.name, setup.view, setup.truth.indirect, cones, paths, frontier));
    section.tables = {std::move(cones), std::move(paths)};
  });
}

StudyResult run_pareto(const StudyRequest& request) {
  // Steps of a quarter would take as long as all of this, and change the error by a hundredth of it (README: step
  // alone).
  ParetoGrid grid{{{32, 64, 128, 256},
                   {0, 1, 2, std::nullopt},
                   {Storage::unorm8, Storage::float32},
                   {1.0f, 0.5f},
                   {4, 6, 9, 16, 32, 64}},
                  192,
                  1024,
                  256,
                  4,
                  3,
                  2.0};
  if (request.quick)
    grid = {{{24, 48, 96}, {0, 1, std::nullopt}, {Storage::unorm8, Storage::float32}, {1.0f, 0.5f}, {4, 6, 16, 32}},
            64,
            256,
            64,
            4,
            3};
  StudyResult result{"pareto", "speed against accuracy"};
  for (const StudyScene& scene :
       scenes_or_own(request, {cornell_point_scene(), light_box_scene()}, true, result.skipped))
    result.sections.push_back(pareto_section(scene, grid, inside(request.progress, scene.name)));
  return result;
}

}  // namespace voxref
