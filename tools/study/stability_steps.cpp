// What the length of a cone's steps does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/statistics.h"
#include "cone/march.h"
#include "cone/raw_march.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

/// Transmittance of a row of samples of raw opacity, `step` voxels apart, that start at the given place.
double raw_transmittance(const Pyramid& pyramid, const Occupancy& occupied, const glm::vec3& start, float step) {
  std::vector<ConeStep> steps;
  constexpr float end = 24.0f;  // beyond the layer
  for (int i = 0; float(i) * step <= end; ++i) steps.push_back({float(i) * step, 0, 0.0f, 1.0f});
  return 1.0 - double(march_raw(pyramid, occupied, ConeAxis(start, {1.0f, 0.0f, 0.0f}), {steps, 1.0f}).opacity);
}

}  // namespace

// Raw samples of a layer of opacity 1/2 see the tent of the interpolation, 1 - 0.5 u at distance 1 - u from its middle.
// With n of them per voxel, averaged over where they fall,
//
//   ln T = n x 2 integral over u in [0,1] of ln(1 - u/2) = n (2 ln 2 - 2) = -0.614 n,
//
// so T = 0.541^n; whole texels in place of the tent would give 0.5^n.
Failure step_dependence() {
  Failure failure{
      "Step dependence",
      "Transmittance of a layer of one voxel and opacity 0.5 for steps of several lengths; geometric mean over where "
      "the samples fall. Opacity read raw is not corrected: n samples per voxel transmit 0.5^n of whole texels, and of "
      "the interpolated ones that are read exp(-(2 - 2 ln 2) n) = 0.541^n. Extinction keeps 0.5 as long as a step is "
      "no longer than a voxel.",
      {"stability_step",
       "Transmittance of a layer of one voxel of opacity 0.5",
       {{"step", "voxels"},
        {"extinction", ""},
        {"extinction_error", ""},
        {"raw", ""},
        {"raw_theory", ""},
        {"whole_texels_theory", ""}}}};
  const Pyramid raw = wall_pyramid(32, 1, 0.5f);
  const Occupancy occupied(raw);
  const Medium medium = make_medium(wall_pyramid(32, 1, 0.5f));
  double worst = 0.0, off_theory = 0.0;
  std::vector<ChartPoint> errors;
  for (const float step : {0.1f, 0.25f, 0.5f, 1.0f, 1.25f, 1.5f, 2.0f}) {
    double log_extinction = 0.0, log_raw = 0.0, error = 0.0;
    constexpr int offsets = 16;
    for (int i = 0; i < offsets; ++i) {
      const glm::vec3 start(4.0f + step * (float(i) + 0.5f) / offsets, 16.0f, 16.0f);
      const double left = 1.0 - double(march(medium, start, {1.0f, 0.0f, 0.0f}, 0.0f, {}, {.step = step}).opacity);
      log_extinction += std::log(left) / offsets;
      log_raw += std::log(raw_transmittance(raw, occupied, start, step)) / offsets;
      error = worst_of({error, std::abs(left - 0.5)});
    }
    const double theory = std::exp((2.0 * std::log(2.0) - 2.0) / double(step));
    failure.table.add(
        {double(step), std::exp(log_extinction), error, std::exp(log_raw), theory, std::pow(0.5, 1.0 / double(step))});
    if (step <= 1.0f) worst = worst_of({worst, error});
    off_theory = worst_of({off_theory, std::abs(log_raw / std::log(theory) - 1.0)});
    errors.push_back(chart_point(double(step), error));
  }
  failure.charts.push_back(
      {"stability_step",
       "A layer of opacity 0.5, marched with steps of several lengths",
       {"step / voxels", true},
       {"transmittance", false, 0.0},
       {curve(failure.table, "step", "extinction", "extinction"),
        curve(failure.table, "step", "raw", "raw opacity", ChartStyle::points),
        theory_curve(failure.table, "step", "raw_theory", "theory, raw, interpolated", "raw opacity"),
        curve(failure.table, "step", "whole_texels_theory", "theory, raw, whole texels", ChartStyle::dashes)}});
  failure.charts.back().marks = {{breaks_at(errors, weber_low), "off by 0.01"}};
  failure.thresholds = {
      {"step_error", worst, "", "most that the transmittance is off 0.5, for steps up to a voxel and any offset"},
      {"step_breaks", breaks_at(errors, weber_low), "voxels", "step from which it may be off by 0.01", Worse::smaller},
      {"step_theory_gap", off_theory, "", "most that the raw optical depth is off theory, relative"}};
  return failure;
}

namespace {

/// What a cone of tangent 1/2 shows of a white wall in front of it, from distances a quarter of a voxel apart.
struct Approach {
  std::vector<double> distances, extinction, raw;
};

Approach approach(float step) {
  constexpr int side = 64;
  constexpr float tangent = 0.5f, nearest = 6.0f, apart = 0.25f, unit = 2.0f;
  constexpr int places = 73;  // to 24 voxels
  const Pyramid pyramid = wall_pyramid(side, 1, 1.0f);
  const Occupancy occupied(pyramid);
  const Medium medium = make_medium(wall_pyramid(side, 1, 1.0f));
  const ConeSteps steps(cone_steps(tangent, {unit, step, float(side), static_cast<int>(pyramid.levels.size()), 0.0f}),
                        1.0f);
  Approach result;
  for (int i = 0; i < places; ++i) {
    const float distance = nearest + float(i) * apart;
    const glm::vec3 origin(0.5f * side + 0.5f - distance, 0.5f * side, 0.5f * side), direction(1.0f, 0.0f, 0.0f);
    result.distances.push_back(double(distance));
    result.extinction.push_back(double(march(medium, origin, direction, tangent, {}, {.step = step}).radiance.r));
    result.raw.push_back(double(march_raw(pyramid, occupied, ConeAxis(origin, direction), steps).radiance.r));
  }
  return result;
}

Series along(const std::vector<double>& x, const std::vector<double>& y, const std::string& title) {
  Series series{title, ChartStyle::line_points};
  for (size_t i = 0; i < x.size(); ++i) series.points.push_back(chart_point(x[i], y[i]));
  return series;
}

}  // namespace

Failure step_bands() {
  Failure failure{
      "Bands of the step's length",
      "A cone looks at a white wall of radiance 1 that fills it, from distances a quarter of a voxel apart; truth is 1 "
      "everywhere. Where samples fall on either side of the wall, opacity read raw changes with the distance, which "
      "shows as bands; steps above a diameter skip the wall.",
      {"stability_step_bands",
       "Radiance of a wall of radiance 1: mean over the distances, and largest less smallest over that",
       {{"step", "cone diameters"}, {"extinction", ""}, {"extinction_bands", ""}, {"raw", ""}, {"raw_bands", ""}}}};
  Chart way{"stability_step_bands_way",
            "A wall of radiance 1, seen from growing distances",
            {"distance / voxels"},
            {"radiance / true radiance", false, 0.0}};
  for (const float step : {0.1f, 0.25f, 0.5f, 0.75f, 1.0f, 1.5f, 2.5f}) {
    const Approach a = approach(step);
    failure.table.add(
        {double(step), mean(a.extinction), spread_over_mean(a.extinction), mean(a.raw), spread_over_mean(a.raw)});
    if (step == 0.5f || step == 2.5f) {
      way.series.push_back(along(a.distances, a.extinction, fmt::format("extinction, step {:g}", step)));
      way.series.push_back(along(a.distances, a.raw, fmt::format("raw opacity, step {:g}", step)));
    }
  }
  way.series.push_back(level_line(1.0, 6.0, 24.0, "theory"));
  const Series extinction = curve(failure.table, "step", "extinction_bands", "extinction"),
               raw = curve(failure.table, "step", "raw_bands", "raw opacity");
  failure.charts = {{"stability_step_bands",
                     "Bands by the step",
                     {"step / cone diameters", true},
                     {"(largest - smallest) / mean", false, 0.0},
                     {extinction, raw}},
                    way};
  failure.charts.front().marks = {{breaks_at(extinction.points, weber_high), "extinction: 2 %"},
                                  {breaks_at(raw.points, weber_high), "raw: 2 %"}};
  failure.thresholds = {{"step_bands", value_at(extinction, double(ConeOptions{}.step)), "",
                         "of a wall's radiance at the shipped step, over its mean"},
                        {"step_bands_break", breaks_at(extinction.points, weber_high), "cone diameters",
                         "step from which extinction shows bands of 2 %", Worse::smaller},
                        {"step_bands_break_raw", breaks_at(raw.points, weber_high), "cone diameters",
                         "step from which raw opacity shows bands of 2 %", Worse::smaller}};
  return failure;
}

}  // namespace voxref
