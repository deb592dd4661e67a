// How a scene lies in the grid, and where in the world.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/statistics.h"
#include "make_scenes/builders.h"
#include "make_scenes/catalog.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

/// Mean radiance that a closed cube, which glows with 1, shows on its floor, from the middle to near an edge.
double shown_by_turned_room(const glm::mat3& turn, int cones) {
  GridOptions grid;
  grid.resolution = 48;
  const Medium medium = glowing_medium(placed(furnace(0.0f), turn, {}), grid);
  std::vector<double> shown;
  constexpr int points = 8;
  for (int i = 0; i < points; ++i) {
    const float x = 0.85f * float(i) / (points - 1);
    shown.push_back(gathered(medium, turn * glm::vec3(x, -1.0f, 0.37f * x), turn * glm::vec3(0.0f, 1.0f, 0.0f), cones));
  }
  return mean(shown);
}

}  // namespace

Failure rotation() {
  Failure failure{
      "Rotation against the grid",
      "A closed cube that glows with radiance 1 shows 1 everywhere. Turned about +Z or about (1, 2, 3), its walls "
      "cross the grid at an angle.",
      {"stability_rotation",
       "What a closed glowing cube shows of its radiance",
       {{"angle", "degrees"},
        {"z_cones_6", ""},
        {"z_cones_32", ""},
        {"oblique_cones_6", ""},
        {"oblique_cones_32", ""}}}};
  double lost = 0.0;
  std::vector<ChartPoint> errors;  // the worst of both axes and numbers of cones
  for (const float degrees : {0.0f, 5.0f, 15.0f, 22.5f, 30.0f, 45.0f, 60.0f}) {
    std::vector<Cell> row = {double(degrees)};
    double at_angle = 0.0;
    for (const glm::vec3 axis : {glm::vec3(0.0f, 0.0f, 1.0f), glm::vec3(1.0f, 2.0f, 3.0f)})
      for (const int cones : {6, 32}) {
        const double shown = shown_by_turned_room(turn_about(axis, degrees), cones);
        row.emplace_back(shown);
        at_angle = worst_of({at_angle, std::abs(1.0 - shown)});
      }
    failure.table.add(std::move(row));
    errors.push_back(chart_point(double(degrees), at_angle));
    lost = worst_of({lost, at_angle});
  }
  failure.charts.push_back({"stability_rotation",
                            "A closed glowing cube, turned against the grid",
                            {"angle / degrees"},
                            {"shown / true radiance"},
                            {curve(failure.table, "angle", "z_cones_6", "about +Z, 6 cones"),
                             curve(failure.table, "angle", "z_cones_32", "about +Z, 32 cones"),
                             curve(failure.table, "angle", "oblique_cones_6", "about (1,2,3), 6 cones"),
                             curve(failure.table, "angle", "oblique_cones_32", "about (1,2,3), 32 cones"),
                             level_line(1.0, 0.0, 60.0, "theory")}});
  failure.charts.back().marks = {{breaks_at(errors, weber_low), "off by 1 %"}};
  failure.thresholds = {
      {"rotation_error", lost, "",
       "most that what a floor shows of a glowing room, mean over eight points, is off at any angle"},
      {"rotation_break", breaks_at(errors, weber_low), "degrees", "from which it is off by 1 %", Worse::smaller}};
  return failure;
}

Failure scale() {
  Failure failure{
      "Scale",
      "The Cornell box with every length times a factor; lights keep the irradiance. The image must not change.",
      {"stability_scale", "Mean radiance over that at scale 1", {{"scale", ""}, {"ratio", ""}, {"change", "1e-6"}}}};
  const double usual = usual_box_mean();
  double off = 0.0;
  for (const float factor : {1e-3f, 1e-2f, 1e-1f, 1.0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f}) {
    const Scene box = scaled(cornell_box(CornellLight::point), factor);
    const double ratio = TryTrace(box, small_settings(box_voxels), box_width).mean() / usual;
    failure.table.add({double(factor), ratio, 1e6 * (ratio - 1.0)});
    off = worst_of({off, std::abs(ratio - 1.0)});
  }
  failure.charts.push_back(
      {"stability_scale",
       "The Cornell box in other sizes",
       {"scale", true},
       {"change of the mean radiance / 1e-6"},
       {curve(failure.table, "scale", "change", "measured"), level_line(0.0, 1e-3, 1e6, "theory")}});
  failure.thresholds = {{"scale_error", off, "", "most that the mean changes from 1e-3 to 1e6"}};
  return failure;
}

Failure distance() {
  Failure failure{
      "Distance from the origin",
      "The Cornell box, half a metre wide, moved away from the origin by 1 to 1e6 m. Coordinates in float32 are then "
      "known to 6e-8 of the distance; where voxels cannot be told apart the grid refuses, and the row says so.",
      {"stability_distance",
       "Mean radiance over that at the origin",
       {{"distance", "m"}, {"rounding", "voxels"}, {"ratio", ""}, {"change", "%"}, {"outcome", ""}}}};
  const Scene box = cornell_box(CornellLight::point);
  const Settings settings = small_settings(box_voxels);
  const double usual = usual_box_mean(), voxel = double(fit_grid(box.bounds(), settings.grid).voxel);
  double reach = 0.0, off = 0.0, silent = 0.0;
  bool reached = false;  // a distance at which it does not work
  for (const float away : {1.0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f}) {
    const double rounding = double(away) * 0x1p-24 / voxel;
    const TryTrace moved(placed(box, glm::mat3(1.0f), glm::vec3(away, 0.0f, 0.0f)), settings, box_width);
    if (!moved.result) {
      reached = true;
      failure.table.add({double(away), rounding, Cell{}, Cell{}, moved.outcome});
      continue;
    }
    const double ratio = moved.mean() / usual;
    failure.table.add({double(away), rounding, ratio, 100.0 * (ratio - 1.0), moved.outcome});
    const bool right = std::abs(ratio - 1.0) <= half_plan_error;
    reached = reached || !right;
    if (!reached) reach = std::log10(double(away));
    if (!right) ++silent;
    if (away <= 1e3f) off = worst_of({off, std::abs(ratio - 1.0)});
  }
  failure.charts.push_back(
      {"stability_distance",
       "The Cornell box far from the origin",
       {"distance / m", true},
       {"change of the mean radiance / %"},
       {curve(failure.table, "distance", "change", "measured; refused beyond"), level_line(0.0, 1.0, 1e6, "theory")}});
  failure.charts.back().marks = {{std::pow(10.0, reach), "right to 5 % before"}};
  failure.thresholds = {{"distance_reach", reach, "decades of metres",
                         "to which, and to all before, the mean is right to 5 %", Worse::smaller},
                        {"distance_error", off, "", "most that the mean is off, to 1000 m"},
                        {"distance_silent", silent, "images", "that are off 5 % and more and came without an error"}};
  return failure;
}

}  // namespace voxref
