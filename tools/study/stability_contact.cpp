// Where cones start.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "make_scenes/shapes.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

/// Radiance over the hemisphere, irradiance / pi, from a rectangle of height b and half-width w that stands at distance
/// d on the receiver's plane: form factor of perpendicular rectangles to a point (Howell C-2 twice).
double perpendicular_factor(double d, double b, double w) {
  const double x = w / d, y = std::hypot(b, d);
  return (std::atan(x) - d / y * std::atan(w / y)) / std::numbers::pi;
}

/// Error of the light of a wall, whose foot is at x = -1, at so many voxels from it.
double wall_error(const Medium& wall_glows, float voxels, int cones, const ConeOptions& options) {
  const float d = voxels * wall_glows.texels.grid.voxel;
  const double truth = perpendicular_factor(double(d), 2.0, 2.0);
  return gathered(wall_glows, {d - 1.0f, 0.0f, 0.03f}, {0.0f, 1.0f, 0.0f}, cones, options) / truth - 1.0;
}

}  // namespace

Failure contact_gap() {
  Failure failure{
      "Contact gap and self-lighting",
      "A cone starts off its surface by cone.start voxels. Too near, a glowing floor lights itself. The floor's light "
      "from a wall that glows is held against the form factor of perpendicular rectangles, one and four voxels from "
      "the "
      "contact: what a start further out would lose. (A march returns to the line from the surface itself as soon as "
      "that has risen as high as the start, so that little is lost.)",
      {"stability_contact",
       "Self-lighting, and relative error of light from a wall near its foot",
       {{"cones", ""}, {"start", "voxels"}, {"self_lighting", ""}, {"error_at_1", ""}, {"error_at_4", ""}}}};
  Chart own_light{"stability_contact_self",
                  "A glowing floor that lights itself",
                  {"cone.start / voxels"},
                  {"self-lighting / radiance", false, 0.0}};
  Chart errors{
      "stability_contact", "Light of a wall near its foot", {"cone.start / voxels"}, {"gathered / true light - 1"}};
  GridOptions grid;
  grid.resolution = 64;
  const Mesh standing = quad({-1.0f, 0.0f, -2.0f}, {-1.0f, 2.0f, -2.0f}, {-1.0f, 2.0f, 2.0f}, {-1.0f, 0.0f, 2.0f});
  const Medium wall_glows = glowing_medium(floor_and(standing, false, true), grid),
               floor_glows = glowing_medium(floor_and(standing, true, false), grid);
  const auto shipped = ConeOptions{}.start;
  double self_lighting = 0.0, gap_1 = 0.0, gap_4 = 0.0, needed = 0.0;
  for (const int cones : {6, 128}) {
    std::vector<ChartPoint> from_far;
    for (const float start : {0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f, 3.0f}) {
      ConeOptions options;
      options.start = start;
      const double own = gathered(floor_glows, {0.5f, 0.0f, 0.03f}, {0.0f, 1.0f, 0.0f}, cones, options);
      const double error_1 = wall_error(wall_glows, 1.0f, cones, options),
                   error_4 = wall_error(wall_glows, 4.0f, cones, options);
      failure.table.add({double(cones), double(start), own, error_1, error_4});
      from_far.insert(from_far.begin(), chart_point(double(start), own));
      if (start != shipped) continue;
      self_lighting = worst_of({self_lighting, own});
      gap_1 = worst_of({gap_1, std::abs(error_1)});
      gap_4 = worst_of({gap_4, std::abs(error_4)});
    }
    constexpr double seen = 0.01;
    needed = worst_of({needed, breaks_at(from_far, seen)});
    const std::pair<std::string, double> these{"cones", cones};
    own_light.series.push_back(
        curve(failure.table, "start", "self_lighting", fmt::format("{} cones", cones), ChartStyle::line_points, these));
    for (const int voxels : {1, 4})
      errors.series.push_back(
          curve(failure.table, "start", fmt::format("error_at_{}", voxels),
                fmt::format("{} voxel{} from the wall, {} cones", voxels, voxels == 1 ? "" : "s", cones),
                ChartStyle::line_points, these));
  }
  errors.series.push_back(level_line(0.0, 0.5, 3.0, "theory"));
  failure.charts = {own_light, errors};
  failure.thresholds = {
      {"self_lighting", self_lighting, "", "of a glowing floor at the shipped start, over its radiance"},
      {"self_lighting_start", needed, "voxels", "least start at which self-lighting is below 1 %"},
      {"contact_error_1", gap_1, "", "relative error one voxel from a glowing wall, shipped start"},
      {"contact_error_4", gap_4, "", "relative error four voxels from a glowing wall, shipped start"}};
  return failure;
}

}  // namespace voxref
