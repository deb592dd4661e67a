#include "study/ladder_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace voxref {

namespace {

constexpr double least_change = 1e-3;  // percent; below it nothing changed

/// Some rungs of a ladder, as one chart shows them.
struct Stretch {
  const StudyScene& scene;
  const LadderClimb& climb;
  size_t begin, end;
  std::string name, title;

  const RungImage& rung(size_t r) const { return climb.rungs[r]; }
  double percent() const { return 100.0 / mean(climb.rungs.front()); }
};

/// Those that change anything in the region, or that nobody can tell of, not being finite.
std::vector<size_t> changing(const Stretch& stretch, const Region& region) {
  std::vector<size_t> found;
  for (size_t r = stretch.begin; r < stretch.end; ++r) {
    const RungStep step = rung_step(stretch.rung(r - 1), stretch.rung(r), region.pixels);
    const double rms = stretch.percent() * step.square.root(), bias = stretch.percent() * std::abs(step.bias.mean);
    if (!(rms <= least_change) || !(bias <= least_change)) found.push_back(r);
  }
  return found;
}

/// A number over a bar, with as many digits as there is room for.
std::string bar_label(double value, bool narrow) {
  const double size = std::abs(value);
  return fmt::format("{:+.{}f}", value, size >= 1000.0 ? 0 : narrow || size >= 100.0 ? 1 : 2);
}

/// Bars of bias that hang on each other from where the stretch begins; too bright, too dark, and the sums.
Chart bias_waterfall(const Stretch& stretch, const Region& region) {
  const bool whole = region.name == "whole";
  Chart chart{"ladder_" + stretch.name + "_" + region.name + "_" + stretch.scene.name,
              stretch.scene.name + (whole ? "" : ", " + region.name) + ": bias " + stretch.title,
              {""},
              {"bias / % of the path-traced mean"},
              {{"brighter", ChartStyle::bars}, {"darker", ChartStyle::bars}, {"sum", ChartStyle::bars}}};
  const double percent = stretch.percent();
  const auto add = [&](size_t series, const std::string& name, const Estimate& bias, double base) {
    const auto x = double(chart.x.categories.size());
    const double value = percent * bias.mean;
    ChartPoint point{x, base + value, percent * bias.error, bar_label(value, stretch.end - stretch.begin > 14), base};
    if (!std::isfinite(point.y)) point = {x, 0.0, 0.0, "not finite"};  // the chart would leave it out
    chart.series[series].points.push_back(point);
    chart.x.categories.push_back(name);
  };
  const auto to = [&](size_t r) { return rung_step(stretch.rung(0), stretch.rung(r), region.pixels).bias; };
  if (stretch.begin > 1) add(2, stretch.rung(stretch.begin - 1).name, to(stretch.begin - 1), 0.0);
  for (const size_t r : changing(stretch, region)) {
    const Estimate bias = rung_step(stretch.rung(r - 1), stretch.rung(r), region.pixels).bias;
    add(bias.mean < 0.0 ? 1 : 0, stretch.rung(r).name, bias, percent * to(r - 1).mean);
  }
  add(2, "sum", to(stretch.end - 1), 0.0);
  return chart;
}

/// RMS difference from the path tracer: for each region, side by side, bars from what it was to what it is. In the
/// goal's parameters, whose units may not be W/(sr m^2), on a logarithmic axis.
Chart rms_waterfall(const Stretch& stretch, const std::vector<Region>& regions) {
  const bool from_start = stretch.begin == 1;
  Chart chart{"ladder_" + stretch.name + "_rms_" + stretch.scene.name,
              stretch.scene.name + ": RMS difference " + stretch.title,
              {""},
              {"RMS difference from the path tracer / % of its mean", !from_start}};
  const double percent = stretch.percent();
  std::vector<size_t> shown = changing(stretch, regions[0]);
  if (!from_start) shown.insert(shown.begin(), stretch.begin - 1);
  for (const size_t r : shown) chart.x.categories.push_back(stretch.rung(r).name);
  const double width = 0.8 / double(regions.size());
  for (size_t k = 0; k < regions.size(); ++k) {
    Series series{regions[k].name, ChartStyle::bars, {}, {}, width};
    const double beside = width * (double(k) - 0.5 * double(regions.size() - 1));
    double before = 0.0;
    for (size_t i = 0; i < shown.size(); ++i) {
      const MeanSquare square = rung_step(stretch.rung(0), stretch.rung(shown[i]), regions[k].pixels).square;
      ChartPoint point{double(i) + beside, percent * square.root()};
      point.base = i == 0 && !from_start ? point.y : before;
      point.y_bar = Interval{percent * square.root(-1.0), percent * square.root(1.0)};
      before = point.y;
      if (!std::isfinite(point.y)) point = {point.x, from_start ? 0.0 : 1.0, 0.0, "not finite"};
      if (!std::isfinite(point.base)) point.base = point.y;
      series.points.push_back(point);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

Table ladder_table(const StudyScene& scene, const LadderClimb& climb, const std::vector<Region>& regions) {
  Table table{"ladder_rungs_" + scene.name,
              "Each rung against the one before, and its RMS difference from the path tracer, in percent of the "
              "path-traced mean; the last row of a region: end to end",
              {{"region", ""},
               {"rung", ""},
               {"bias", "%"},
               {"bias_stderr", "%"},
               {"rms", "%"},
               {"rms_stderr", "%"},
               {"rms_to_path", "%"},
               {"rms_to_path_stderr", "%"}}};
  const std::vector<RungImage>& rungs = climb.rungs;
  const double percent = 100.0 / mean(rungs.front());
  for (const Region& region : regions) {
    const auto add = [&](const std::string& name, const RungStep& step, const RungStep& total) {
      table.add({region.name, name, percent * step.bias.mean, percent * step.bias.error, percent * step.square.root(),
                 percent * step.square.root_stderr(), percent * total.square.root(),
                 percent * total.square.root_stderr()});
    };
    for (size_t r = 1; r < rungs.size(); ++r)
      add(rungs[r].name, rung_step(rungs[r - 1], rungs[r], region.pixels),
          rung_step(rungs[0], rungs[r], region.pixels));
    const RungStep total = rung_step(rungs.front(), rungs.back(), region.pixels);
    add("total", total, total);
  }
  return table;
}

std::vector<Chart> ladder_charts(const StudyScene& scene, const LadderClimb& climb, const std::vector<Region>& regions,
                                 const std::string& goal) {
  std::vector<Stretch> stretches = {{scene, climb, 1, climb.first_parameter, "method", "of each approximation"}};
  if (climb.rungs.size() > climb.first_parameter)
    stretches.push_back({scene, climb, climb.first_parameter, climb.rungs.size(), "parameters",
                         "on the way from the method to " + goal});
  std::vector<Chart> charts;
  for (const Stretch& stretch : stretches) {
    for (const Region& region : regions) charts.push_back(bias_waterfall(stretch, region));
    charts.push_back(rms_waterfall(stretch, regions));
  }
  return charts;
}

}  // namespace voxref
