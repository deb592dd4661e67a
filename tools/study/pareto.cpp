// Speed against accuracy: relative error of the indirect light over time, for the cone tracer's settings and for the
// path tracer's samples.
#include "study/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "reference/path.h"
#include "study/cone_runner.h"
#include "study/deviation.h"
#include "study/study_scenes.h"

namespace voxref {

namespace {

constexpr double confidence = 1.96;  // standard errors to either side of a 95 % interval

struct Setup {
  const StudyScene& scene;
  View view;
  Caster caster;
  bool indirect;
  Measured truth;
};

Setup make_setup(const StudyScene& scene, const ParetoGrid& grid, const Progress& progress) {
  Setup setup{
      scene, sized(scene.view, grid.width), Caster(scene.scene), compares_indirect(scene.scene, scene.view), {}};
  PathOptions options;
  options.spp = grid.reference_spp;
  setup.truth =
      measured_path(path_trace(scene.scene, setup.caster, setup.view, options, progress).image, setup.indirect);
  return setup;
}

std::string word(const std::optional<int>& bounces) { return bounces ? std::to_string(*bounces) : "auto"; }
std::string word(Storage storage) {
  Settings settings;
  settings.storage = storage;
  return to_json(settings)["storage"];
}

Table cone_table(const Setup& setup, const ParetoGrid& grid, const Progress& progress) {
  Table table{"pareto_" + setup.scene.name + "_cones",
              "Cone tracer: every setting with its error and the seconds of all its stages",
              {{"voxels", ""},
               {"bounces", ""},
               {"storage", ""},
               {"step", ""},
               {"cones", ""},
               {"time", "s"},
               {"rel_error", ""},
               {"rel_error_95", ""},
               {"bias", ""},
               {"memory", "MiB"},
               {"frontier", ""}},
              {}};
  ConeRunner runner(setup.scene.scene, setup.caster, setup.view, progress);
  Settings settings;
  for (const int resolution : grid.resolutions)
    for (const auto& bounces : grid.bounces)
      for (const Storage storage : grid.storages)
        for (const float step : grid.steps)
          for (const int cones : grid.cones) {
            progress.check();
            settings.grid.resolution = resolution;
            settings.bounce.count = bounces;
            settings.storage = storage;
            settings.render.cone.step = step;
            settings.render.cone.diffuse = cones;
            const ConeTraceResult result = runner(settings);
            const Deviation d = deviation(measured_cone(result.image.image, setup.indirect), setup.truth);
            table.add({double(resolution), word(bounces), word(storage), double(step), double(cones),
                       result.seconds.total, d.rel_error, confidence * d.rel_error_error, d.bias,
                       std::ldexp(double(result.bytes.at("total")), -20), std::string()});
          }
  return table;
}

/// Error and time of images that are all the path tracer's, over independent seeds; the noise is the error.
Table path_table(const Setup& setup, const ParetoGrid& grid, const Progress& progress) {
  Table table{"pareto_" + setup.scene.name + "_paths",
              fmt::format("Path tracer: mean of {} seeds", grid.seeds),
              {{"samples", ""}, {"time", "s"}, {"rel_error", ""}, {"rel_error_95", ""}},
              {}};
  for (int spp = 1; spp <= grid.most_spp; spp *= 2) {
    double seconds = 0.0, sum = 0.0, squares = 0.0;
    for (int seed = 1; seed <= grid.seeds; ++seed) {
      PathOptions options;
      options.spp = spp;
      options.randomizations = 1;
      options.seed = static_cast<uint64_t>(seed);  // the truth has seed 0
      const PathResult result = path_trace(setup.scene.scene, setup.caster, setup.view, options, progress);
      Measured image = measured_path(result.image, setup.indirect);
      image.standard_error.assign(image.value.size(), 0.0);
      const double error = deviation(image, setup.truth).rel_error;
      seconds += result.seconds / grid.seeds;
      sum += error / grid.seeds;
      squares += error * error / grid.seeds;
    }
    const double variance = std::max(0.0, squares - sum * sum) / (grid.seeds - 1);
    table.add({double(spp), seconds, sum, confidence * std::sqrt(variance)});
  }
  return table;
}

std::vector<Tradeoff> tradeoffs(const Table& table) {
  std::vector<Tradeoff> points;
  for (size_t i = 0; i < table.rows.size(); ++i)
    points.push_back({table.number(i, "time"), table.number(i, "rel_error")});
  return points;
}

ChartPoint chart_point(const Table& table, size_t row, const std::string& label) {
  return {table.number(row, "time"), 100.0 * table.number(row, "rel_error"), 100.0 * table.number(row, "rel_error_95"),
          label};
}

Chart pareto_chart(const Setup& setup, const Table& cones, const Table& paths, std::span<const size_t> frontier) {
  Chart chart{"pareto_" + setup.scene.name,
              fmt::format("{}, {}x{} pixels: error of the {} light against time", setup.scene.name, setup.view.width,
                          setup.view.height, setup.indirect ? "indirect" : "whole"),
              {"time of the whole image / s", true, {}, {}, {}},
              {"relative error (RMS, noise removed) / %", true, {}, {}, {}},
              {}};
  std::map<double, Series> by_resolution;
  for (size_t i = 0; i < cones.rows.size(); ++i) {
    Series& series = by_resolution[cones.number(i, "voxels")];
    series.title = fmt::format("cones, {} voxels", cones.number(i, "voxels"));
    series.points.push_back(chart_point(cones, i, ""));
  }
  Series samples{"path tracer, samples", ChartStyle::line_points, {}};
  for (size_t i = 0; i < paths.rows.size(); ++i)
    samples.points.push_back(chart_point(paths, i, fmt::format("{}", paths.number(i, "samples"))));
  Series best{"cones' frontier: voxels/cones/bounces", ChartStyle::line, {}};
  double labelled = 0.0;
  for (const size_t i : frontier) {
    // A label needs a fifth of a decade of its own.
    const bool room = cones.number(i, "time") > 1.6 * labelled;
    if (room) labelled = cones.number(i, "time");
    const std::string label = fmt::format("{}/{}/{}", cones.number(i, "voxels"), cones.number(i, "cones"),
                                          std::get<std::string>(cones.rows[i][cones.column("bounces")]));
    best.points.push_back(chart_point(cones, i, room ? label : ""));
  }
  for (auto& [resolution, series] : by_resolution) chart.series.push_back(std::move(series));
  chart.series.push_back(std::move(samples));
  chart.series.push_back(std::move(best));
  return chart;
}

std::string findings(const Table& cones, const Table& paths, std::span<const size_t> frontier) {
  const size_t best = frontier.back();
  const double error = cones.number(best, "rel_error");
  std::string text = fmt::format(
      "Error: RMS difference of luminance over the mean of the path-traced light, with the noise of the truth removed "
      "and "
      "95 % confidence limits. Time: of all stages, measured once each on this machine and booked to every setting "
      "that "
      "uses them; for the path tracer that of its render loop.\n\nThe most accurate of {} settings is {:.1f} % off in "
      "{:.3g} "
      "s.",
      cones.rows.size(), 100.0 * error, cones.number(best, "time"));
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
    if (frontier.empty() || points[i].error < points[frontier.back()].error) frontier.push_back(i);
  return frontier;
}

Section pareto_section(const StudyScene& scene, const ParetoGrid& grid, const Progress& progress) {
  return timed_section(scene.name, [&](Section& section) {
    const Setup setup = make_setup(scene, grid, progress);
    Table cones = cone_table(setup, grid, progress);
    const std::vector<size_t> frontier = pareto_frontier(tradeoffs(cones));
    for (const size_t i : frontier) cones.rows[i].back() = "yes";
    Table paths = path_table(setup, grid, progress);
    section.text = findings(cones, paths, frontier);
    section.charts.push_back(pareto_chart(setup, cones, paths, frontier));
    section.tables = {std::move(cones), std::move(paths)};
  });
}

StudyResult run_pareto(const StudyRequest& request) {
  ParetoGrid grid{{32, 64, 128, 256},
                  {4, 6, 9, 16, 32, 64},
                  {0.25f, 0.5f, 1.0f},
                  {0, 1, 2, std::nullopt},
                  {Storage::float32, Storage::unorm8},
                  256,
                  1024,
                  256,
                  4};
  if (request.quick)
    grid = {{24, 48, 96},
            {4, 6, 16, 32},
            {0.5f, 1.0f},
            {0, 1, std::nullopt},
            {Storage::float32, Storage::unorm8},
            96,
            256,
            64,
            3};
  StudyResult result{"pareto", "speed against accuracy", {}, {}};
  std::vector<StudyScene> own;
  if (request.scenes.empty()) {
    own = {cornell_point_scene(), light_box_scene()};
    if (!request.quick) {
      if (auto sponza = public_scene("sponza", request.assets, true))
        own.push_back(std::move(*sponza));
      else
        result.skipped.push_back("sponza: not in VOXREF_ASSETS");
    }
  }
  for (const StudyScene& scene : request.scenes.empty() ? own : request.scenes)
    result.sections.push_back(pareto_section(scene, grid, request.progress));
  return result;
}

}  // namespace voxref
