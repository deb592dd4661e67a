#include "study/pareto_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "study/pareto.h"

namespace voxref {

namespace {

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

}  // namespace

Chart pareto_chart(const std::string& scene, const View& view, bool indirect, const Table& cones, const Table& paths,
                   std::span<const size_t> frontier) {
  Chart chart{"pareto_" + scene,
              fmt::format("{}, {}x{} pixels: error of the {} light against time", scene, view.width, view.height,
                          indirect ? "indirect" : "whole"),
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

}  // namespace voxref
