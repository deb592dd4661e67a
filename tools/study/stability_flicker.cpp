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
constexpr int resolution = 48;
const glm::vec3 looked_at(0.1f, 0.0f, 0.07f);

/// Light over the true light along the way, per number of cones.
using Runs = std::vector<std::pair<int, std::vector<double>>>;

float shift_of(size_t sample, float voxel) { return voxel * float(sample * periods) / float(samples); }

Failure flicker_of(const std::string& name, const std::string& title, const std::string& text, const Runs& runs) {
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
  for (const auto& [cones, ratios] : runs) {
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
  return failure;
}

}  // namespace

Failure flicker() {
  Runs runs = {{6, {}}, {32, {}}};
  GridOptions grid;
  grid.resolution = resolution;
  grid.bounds = Bounds{{-2.1f, -0.2f, -2.1f}, {2.1f, 1.4f, 2.1f}};  // the grid stands still
  for (size_t i = 0; i < samples; ++i) {
    const float shift = shift_of(i, 4.2f / resolution);
    const Medium medium = glowing_medium(floor_and_ball(shift), grid);
    const double truth = ball_light(looked_at - glm::vec3(shift, 0.0f, 0.0f));
    for (auto& [cones, ratios] : runs) ratios.push_back(gathered(medium, looked_at, {0.0f, 1.0f, 0.0f}, cones) / truth);
  }
  return flicker_of("stability_flicker_object", "Flicker of a moving object's light",
                    "A glowing ball moves by fractions of a voxel over a floor at rest; the light at one point of the "
                    "floor.",
                    runs);
}

Failure camera_flicker() {
  Runs runs = {{6, {}}, {32, {}}};
  GridOptions grid;
  grid.resolution = resolution;
  const Medium medium = glowing_medium(floor_and_ball(0.0f), grid);
  for (size_t i = 0; i < samples; ++i) {
    const glm::vec3 p = looked_at + glm::vec3(shift_of(i, medium.texels.grid.voxel), 0.0f, 0.0f);
    for (auto& [cones, ratios] : runs) ratios.push_back(gathered(medium, p, {0.0f, 1.0f, 0.0f}, cones) / ball_light(p));
  }
  return flicker_of("stability_flicker_camera", "Light along a moving camera's way",
                    "Nothing moves but the point that is looked at, by fractions of a voxel along the floor.", runs);
}

}  // namespace voxref
