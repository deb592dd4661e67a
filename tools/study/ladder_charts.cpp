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

/// Adds one category after the other to a waterfall.
class Waterfall {
 public:
  Waterfall(const Stretch& stretch, const Region& region) : stretch_(stretch), region_(region) {
    const bool whole = region.name == "whole";
    chart_ = {"ladder_" + stretch.name + "_" + region.name + "_" + stretch.scene.name,
              stretch.scene.name + (whole ? "" : ", " + region.name) + ": " + stretch.title,
              {""},
              {"% of the path-traced mean"},
              {{"brighter", ChartStyle::bars},
               {"darker", ChartStyle::bars},
               {"bias so far", ChartStyle::bars},
               {"RMS difference from the path tracer so far", ChartStyle::line_points}}};
  }

  /// What separates rung r from the one before.
  void add_step(size_t r) {
    const Estimate bias = rung_step(stretch_.rung(r - 1), stretch_.rung(r), region_.pixels).bias;
    add(bias.mean < 0.0 ? 1 : 0, r, stretch_.rung(r).name, bias, stretch_.percent() * to(r - 1).bias.mean);
  }
  /// What separates rung r from the path tracer.
  void add_sum(size_t r, const std::string& name) { add(2, r, name, to(r).bias, 0.0); }

  Chart chart() && { return std::move(chart_); }

 private:
  RungStep to(size_t r) const { return rung_step(stretch_.rung(0), stretch_.rung(r), region_.pixels); }

  void add(size_t series, size_t r, const std::string& name, const Estimate& bias, double base) {
    const auto x = double(chart_.x.categories.size());
    const double percent = stretch_.percent(), value = percent * bias.mean;
    chart_.x.categories.push_back(name);
    if (!std::isfinite(base + value)) {  // the chart would leave it out
      chart_.series[series].points.push_back({x, 0.0, 0.0, "not finite"});
      return;
    }
    const int digits = stretch_.end - stretch_.begin > 14 ? 1 : 2;  // as many as there is room for
    chart_.series[series].points.push_back(
        {x, base + value, percent * bias.error, fmt::format("{:+.{}f}", value, digits), base});
    const MeanSquare square = to(r).square;
    ChartPoint rms{x, percent * square.root()};
    rms.y_bar = Interval{percent * square.root(-1.0), percent * square.root(1.0)};
    chart_.series[3].points.push_back(rms);
  }

  const Stretch& stretch_;
  const Region& region_;
  Chart chart_;
};

/// Bars that hang on each other from where the stretch begins; too bright, too dark, and the sums.
Chart waterfall(const Stretch& stretch, const Region& region) {
  Waterfall fall(stretch, region);
  if (stretch.begin > 1) fall.add_sum(stretch.begin - 1, stretch.rung(stretch.begin - 1).name);
  for (const size_t r : changing(stretch, region)) fall.add_step(r);
  fall.add_sum(stretch.end - 1, "sum");
  return std::move(fall).chart();
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
  std::vector<Stretch> stretches = {{scene, climb, 1, climb.first_parameter, "method", "what each approximation adds"}};
  if (climb.rungs.size() > climb.first_parameter)
    stretches.push_back(
        {scene, climb, climb.first_parameter, climb.rungs.size(), "parameters", "from the method to " + goal});
  std::vector<Chart> charts;
  for (const Stretch& stretch : stretches)
    for (const Region& region : regions) charts.push_back(waterfall(stretch, region));
  return charts;
}

}  // namespace voxref
