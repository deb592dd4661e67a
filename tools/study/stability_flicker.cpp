// What repeats with the voxel when something moves.
#include <fmt/format.h>

#include <cmath>

#include "compare/statistics.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

constexpr size_t samples = 32, periods = 2;  // of the way, which is as many voxels long
constexpr int usual_resolution = 48, shipped_cones = 6;
const glm::vec3 looked_at(0.1f, 0.0f, 0.07f), up(0.0f, 1.0f, 0.0f);

/// Light over the true light along the way, per number of cones.
struct Runs {
  float voxel = 0.0f;  ///< m
  std::vector<std::pair<int, std::vector<double>>> by_cones;

  explicit Runs(const std::vector<int>& cones) {
    for (const int count : cones) by_cones.push_back({count, {}});
  }
  float shift(size_t sample) const { return voxel * float(sample * periods) / float(samples); }
};
/// Measures in a grid of this resolution for numbers of cones.
using Measure = Runs (*)(int resolution, const std::vector<int>& cones);

Runs moving_ball(int resolution, const std::vector<int>& cones) {
  GridOptions grid;
  grid.resolution = resolution;
  grid.bounds = Bounds{{-2.1f, -0.2f, -2.1f}, {2.1f, 1.4f, 2.1f}};  // the grid stands still
  Runs runs(cones);
  runs.voxel = grid.bounds->extent().x / float(resolution);
  for (size_t i = 0; i < samples; ++i) {
    const Medium medium = glowing_medium(floor_and_ball(runs.shift(i)), grid);
    const double truth = ball_light(looked_at - glm::vec3(runs.shift(i), 0.0f, 0.0f));
    for (auto& [count, ratios] : runs.by_cones) ratios.push_back(gathered(medium, looked_at, up, count) / truth);
  }
  return runs;
}

Runs moving_camera(int resolution, const std::vector<int>& cones) {
  GridOptions grid;
  grid.resolution = resolution;
  const Medium medium = glowing_medium(floor_and_ball(0.0f), grid);
  Runs runs(cones);
  runs.voxel = medium.texels.grid.voxel;
  for (size_t i = 0; i < samples; ++i) {
    const glm::vec3 p = looked_at + glm::vec3(runs.shift(i), 0.0f, 0.0f);
    for (auto& [count, ratios] : runs.by_cones) ratios.push_back(gathered(medium, p, up, count) / ball_light(p));
  }
  return runs;
}

/// Ripple of the shipped number of cones by the voxels that the ball's radius has, and from where on it is seen.
void add_size(Failure& failure, const std::string& name, const std::string& title, Measure measure) {
  Series ripples{fmt::format("{} cones", shipped_cones), ChartStyle::line_points};
  for (const int resolution : {128, 96, 64, 48, 32, 24}) {
    const Runs runs = measure(resolution, {shipped_cones});
    ripples.points.push_back(
        chart_point(double(ball_radius) / double(runs.voxel), ripple(runs.by_cones.front().second)));
  }
  const double needed = breaks_at(ripples.points, half_plan_error);
  failure.charts.push_back({name + "_size",
                            title + " by the ball's size",
                            {"radius / voxels", true},
                            {"peak to peak / mean", false, 0.0},
                            {std::move(ripples)},
                            {{needed, "5 %"}}});
  failure.thresholds.push_back(
      {name + "_break", needed, "voxels",
       fmt::format("radius below which the light of {} cones flickers by 5 %", shipped_cones)});
}

Failure flicker_of(const std::string& name, const std::string& title, const std::string& text, Measure measure) {
  const Runs runs = measure(usual_resolution, {shipped_cones, 32});
  Failure failure{
      title,
      text +
          " Shown is the light over that in closed form, so that what varies is the method's, over its mean; the "
          "spectrum is of what is left when its straight trend is taken off.",
      {name,
       "Light on the floor along the way, over the true light",
       {{"cones", ""}, {"shift", "voxels"}, {"ratio", ""}}}};
  Chart way{name, title, {"shift / voxels"}, {"gathered / true light, over its mean"}};
  Chart spectrum{name + "_spectrum",
                 title + ": spectrum",
                 {.title = "frequency / (1 / voxel)", .categories = {"1", "2", "3", "4"}},
                 {"amplitude / mean", true}};
  for (const auto& [cones, ratios] : runs.by_cones) {
    const std::string title_of_run = fmt::format("{} cones", cones);
    Series along{title_of_run, ChartStyle::line_points}, lines{title_of_run, ChartStyle::line_points};
    for (size_t i = 0; i < ratios.size(); ++i) {
      const double shift = double(i * periods) / double(ratios.size());
      failure.table.add({double(cones), shift, ratios[i]});
      along.points.push_back(chart_point(shift, ratios[i] / mean(ratios)));
    }
    const std::vector<double> amplitudes = harmonics(ratios, periods, 4);
    for (size_t k = 0; k < amplitudes.size(); ++k) lines.points.push_back(chart_point(double(k), amplitudes[k]));
    way.series.push_back(std::move(along));
    spectrum.series.push_back(std::move(lines));
    failure.thresholds.push_back({fmt::format("{}_{}_cones", name, cones), ripple(ratios), "",
                                  "peak to peak of the light less its straight trend, over its mean"});
    failure.thresholds.push_back({fmt::format("{}_{}_cones_per_voxel", name, cones), amplitudes[0], "",
                                  "amplitude that repeats with the voxel, over the mean"});
    failure.thresholds.push_back({fmt::format("{}_{}_cones_light", name, cones), std::abs(mean(ratios) - 1.0), "",
                                  "how far that mean is off the true light, relative"});
    failure.text += fmt::format(" With {} cones it is {:.2f} times the true light in the mean.", cones, mean(ratios));
  }
  failure.charts = {std::move(way), std::move(spectrum)};
  add_size(failure, name, title, measure);
  return failure;
}

}  // namespace

Failure flicker() {
  return flicker_of("stability_flicker_object", "Flicker of a moving object's light",
                    "A glowing ball moves by fractions of a voxel over a floor at rest; the light at one point of the "
                    "floor.",
                    moving_ball);
}

Failure camera_flicker() {
  return flicker_of("stability_flicker_camera", "Light along a moving camera's way",
                    "Nothing moves but the point that is looked at, by fractions of a voxel along the floor.",
                    moving_camera);
}

}  // namespace voxref
