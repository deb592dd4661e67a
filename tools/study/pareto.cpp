// Speed against accuracy: relative error of the indirect light over time, for the cone tracer's settings and for the
// path tracer's samples.
#include "study/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>

#include "compare/statistics.h"
#include "study/cone_runner.h"
#include "study/deviation.h"
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
Table path_table(const Setup& setup, const ParetoGrid& grid, const Progress& progress) {
  Table table{"pareto_" + setup.scene.name + "_paths",
              fmt::format("Path tracer: mean error of {} seeds", grid.seeds),
              {{"samples", ""}}};
  for (const Column& column : measured_columns()) table.columns.push_back(column);
  for (int spp = 1; spp <= grid.most_spp; spp *= 2) {
    std::vector<double> seconds, errors;
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
    }
    const Estimate error = estimate(errors);
    const double limit = student_quantile(significance, error.freedom) * error.error;
    std::vector<Cell> row = {double(spp)};
    append(row, measured_cells(spread(seconds), error.mean, {std::max(0.0, error.mean - limit), error.mean + limit}));
    table.add(std::move(row));
  }
  return table;
}

std::vector<Tradeoff> tradeoffs(const Table& table) {
  std::vector<Tradeoff> points;
  for (size_t i = 0; i < table.rows.size(); ++i)
    points.push_back({table.number(i, "time"), table.number(i, "rel_error")});
  return points;
}

/// @param bars whether its error bars are drawn: of hundreds of points they would hide each other
ChartPoint chart_point(const Table& table, size_t row, const std::string& label, bool bars) {
  const auto percent = [&](const char* column) { return 100.0 * table.number(row, column); };
  ChartPoint point{table.number(row, "time"), percent("rel_error"), 0.0, label};
  if (!bars) return point;
  point.x_bar = Interval{table.number(row, "time_least"), table.number(row, "time_greatest")};
  point.y_bar = Interval{percent("rel_error_low"), percent("rel_error_high")};
  return point;
}

/// a to z, then A to Z; empty after those.
std::string letter(size_t index) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  return std::string(letters.substr(std::min(index, letters.size()), 1));
}

/// What the letters at the frontier mean, and the frontier itself. Points that are too close to the one labelled before
/// have none.
Series frontier_series(const Table& cones, std::span<const size_t> frontier, std::vector<std::string>& notes) {
  Series series{"the cones' frontier", ChartStyle::line_points};
  notes.emplace_back("On the frontier:");
  std::optional<Tradeoff> labelled;
  size_t letters = 0;
  for (const size_t i : frontier) {
    constexpr double room = 1.15;  // that a letter needs of its own, in time or error
    const Tradeoff here{cones.number(i, "time"), cones.number(i, "rel_error")};
    std::string label;
    if (!labelled || here.seconds > room * labelled->seconds || labelled->error > room * here.error) {
      labelled = here;
      label = letter(letters++);
      const auto word = [&](const char* column) { return display(cones.rows[i][cones.column(column)]); };
      notes.push_back(fmt::format("{}  {} voxels, bounces {}, {}, step {}, {} cones", label, word("voxels"),
                                  word("bounces"), word("storage"), word("step"), word("cones")));
    }
    series.points.push_back(chart_point(cones, i, label, true));
  }
  return series;
}

Chart pareto_chart(const Setup& setup, const Table& cones, const Table& paths, std::span<const size_t> frontier) {
  Chart chart{"pareto_" + setup.scene.name,
              fmt::format("{}, {}x{} pixels: error of the {} light against time", setup.scene.name, setup.view.width,
                          setup.view.height, setup.truth.indirect ? "indirect" : "whole"),
              {"time of the whole image / s", true},
              {"relative error (RMS, noise removed) / %", true}};
  std::map<double, Series> by_resolution;
  for (size_t i = 0; i < cones.rows.size(); ++i) {
    Series& series = by_resolution[cones.number(i, "voxels")];
    series.title = fmt::format("cones, {} voxels", cones.number(i, "voxels"));
    series.points.push_back(chart_point(cones, i, "", false));
  }
  Series samples{"path tracer, samples per pixel", ChartStyle::line_points};
  for (size_t i = 0; i < paths.rows.size(); ++i)
    samples.points.push_back(chart_point(paths, i, fmt::format("{}", paths.number(i, "samples")), true));
  for (auto& [resolution, series] : by_resolution) chart.series.push_back(std::move(series));
  chart.series.push_back(std::move(samples));
  chart.series.push_back(frontier_series(cones, frontier, chart.notes));
  return chart;
}

/// Says of which settings the images have no error, and whether the truth lacks paths; empty where all is finite.
std::string not_finite(const Table& cones, const Truth& truth) {
  std::string text = truth.missing().empty() ? "" : "\n\n" + truth.missing() + ".";
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
    Table paths = path_table(setup, grid, progress);
    section.text = findings(cones, paths, frontier) + not_finite(cones, setup.truth);
    section.charts.push_back(pareto_chart(setup, cones, paths, frontier));
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
