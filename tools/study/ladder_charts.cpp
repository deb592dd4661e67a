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
  std::string suffix, title;

  const RungImage& rung(size_t r) const { return climb.rungs[r]; }
  double percent() const { return 100.0 / mean(climb.rungs.front()); }
  std::string name() const { return "ladder_" + scene.name + suffix; }
};

/// Those that change anything in the region.
std::vector<size_t> changing(const Stretch& stretch, const Region& region) {
  std::vector<size_t> found;
  for (size_t r = stretch.begin; r < stretch.end; ++r) {
    const RungStep step = rung_step(stretch.rung(r - 1), stretch.rung(r), region.pixels);
    if (stretch.percent() * std::max(step.square.root(), std::abs(step.bias.mean)) > least_change) found.push_back(r);
  }
  return found;
}

/// Bars that hang on each other from where the stretch begins; too bright, too dark, and the sums.
Chart waterfall(const Stretch& stretch, const Region& region) {
  const bool whole = region.name == "whole";
  Chart chart{stretch.name() + (whole ? "" : "_" + region.name),
              stretch.scene.name + (whole ? "" : ", " + region.name) + ": " + stretch.title,
              {""},
              {"bias / % of the path-traced mean"},
              {{"brighter", ChartStyle::bars}, {"darker", ChartStyle::bars}, {"sum", ChartStyle::bars}}};
  const double percent = stretch.percent();
  const int digits = stretch.end - stretch.begin > 14 ? 1 : 2;  // as many as there is room for
  const auto add = [&](size_t series, const std::string& name, const Estimate& bias, double base) {
    const double value = percent * bias.mean;
    chart.series[series].points.push_back({double(chart.x.categories.size()), base + value, percent * bias.error,
                                           fmt::format("{:+.{}f}", value, digits), base});
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

/// RMS of each rung's own change, per region; on a logarithmic axis, since published units are not W/(sr m^2).
Chart rms_chart(const Stretch& stretch, const std::vector<Region>& regions) {
  Chart chart{stretch.name() + "_rms",
              stretch.scene.name + ": RMS of each change",
              {""},
              {"RMS change / % of the path-traced mean", true}};
  const double percent = stretch.percent();
  const std::vector<size_t> shown = changing(stretch, regions[0]);
  for (const size_t r : shown) chart.x.categories.push_back(stretch.rung(r).name);
  for (size_t k = 0; k < regions.size(); ++k) {
    Series series{regions[k].name, ChartStyle::points};
    const double beside = 0.12 * (double(k) - 0.5 * double(regions.size() - 1));
    for (size_t i = 0; i < shown.size(); ++i) {
      const MeanSquare square = rung_step(stretch.rung(shown[i] - 1), stretch.rung(shown[i]), regions[k].pixels).square;
      if (percent * square.root() <= least_change) continue;
      ChartPoint point{double(i) + beside, percent * square.root()};
      point.y_bar = Interval{percent * square.root(-1.0), percent * square.root(1.0)};
      series.points.push_back(point);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

double mean(const RungImage& image) {
  double sum = 0.0;
  for (const auto& values : image.tries) sum += mean(values);
  return sum / double(image.tries.size());
}

Table ladder_table(const StudyScene& scene, const LadderClimb& climb, const std::vector<Region>& regions) {
  Table table{
      "ladder_" + scene.name,
      "Each rung against the one before, in percent of the path-traced mean; the last row of a region: end to end",
      {{"region", ""},
       {"rung", ""},
       {"bias", "%"},
       {"bias_stderr", "%"},
       {"rms", "%"},
       {"rms_stderr", "%"},
       {"rms_to_path", "%"}}};
  const std::vector<RungImage>& rungs = climb.rungs;
  const double percent = 100.0 / mean(rungs.front());
  for (const Region& region : regions) {
    const auto add = [&](const std::string& name, const RungStep& step, const RungStep& total) {
      table.add({region.name, name, percent * step.bias.mean, percent * step.bias.error, percent * step.square.root(),
                 percent * step.square.root_stderr(), percent * total.square.root()});
    };
    for (size_t r = 1; r < rungs.size(); ++r)
      add(rungs[r].name, rung_step(rungs[r - 1], rungs[r], region.pixels),
          rung_step(rungs[0], rungs[r], region.pixels));
    const RungStep total = rung_step(rungs.front(), rungs.back(), region.pixels);
    add("total", total, total);
  }
  return table;
}

std::vector<Chart> ladder_charts(const StudyScene& scene, const LadderClimb& climb,
                                 const std::vector<Region>& regions) {
  std::vector<Stretch> stretches = {
      {scene, climb, 1, climb.first_published, "", "what each approximation adds to the mean"}};
  if (climb.rungs.size() > climb.first_published)
    stretches.push_back({scene, climb, climb.first_published, climb.rungs.size(), "_published",
                         "from the method to the published shaders"});
  std::vector<Chart> charts;
  for (const Stretch& stretch : stretches) {
    for (const Region& region : regions) charts.push_back(waterfall(stretch, region));
    charts.push_back(rms_chart(stretch, regions));
  }
  return charts;
}

}  // namespace voxref
