// Light through a wall, texel by texel.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <span>

#include "cone/march.h"
#include "cone/raw_march.h"
#include "cone/raw_volume.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

constexpr int wall_side = 64;
constexpr std::array levels = {1, 2, 3, 4};
/// Beyond this angle to a wall's normal lies 1 - sin^2 = 7 % of what arrives, by the cosine.
constexpr int steepest = 75;
/// Single precision of a position of up to 64 voxels, times the texels' difference.
constexpr double leak_tolerance = 1e-5;
const Axis leak_axis{"transmitted / incident", false, 0.0};

/// Opacity of the wall's texel at a level as one sample of a published cone reads it, in that texel's middle.
double published_opacity(const RawVolume& volume, int level, double degrees) {
  const auto texel = static_cast<float>(1 << level), angle = glm::radians(static_cast<float>(degrees));
  const glm::vec3 middle(static_cast<float>(wall_side / 2) + 0.5f * texel),
      direction(std::cos(angle), std::sin(angle), 0.0f);
  constexpr float distance = 8.0f;  // any: the sample's level is given
  const ConeSteps one({{distance, level, 0.0f, 1.0f}}, 1.0f);
  return double(
      march_raw(volume.texels, volume.occupied, ConeAxis(middle - distance * direction, direction), one).opacity);
}

/// Opacity, seen edge-on, of the texel of a level that holds the first `thickness` of the 2^level layers which it has
/// room for. Along the way two texels of the level below stand behind each other, composited as if what they cover were
/// independent; across it the two neighbours' mean is taken: e' = mean of 1 - (1 - e)^2.
double edge_on(int level, int thickness) {
  if (thickness <= 0) return 0.0;
  if (level == 0) return 1.0;
  const auto behind_itself = [](double e) { return 1.0 - (1.0 - e) * (1.0 - e); };
  const int half = 1 << (level - 1);
  return 0.5 * (behind_itself(edge_on(level - 1, thickness)) + behind_itself(edge_on(level - 1, thickness - half)));
}

/// Seen at an angle to its normal, one texel of the wall: cos^2 x (is anything in it) + sin^2 e.
double predicted_leak(int level, int thickness, double degrees) {
  const double s = std::sin(glm::radians(degrees));
  return s * s * (1.0 - edge_on(level, thickness));
}

/// The same of spec section 8, by the wall's area alone: cos^2 + sin^2 m 2^-k.
double leak_by_area(int level, int thickness, double degrees) {
  const double s = std::sin(glm::radians(degrees));
  return s * s * (1.0 - std::min(1.0, thickness * std::exp2(-level)));
}

/// Transmittance of a cone whose texels are those of `level` where it meets the wall at an angle to its normal.
double extinction_leak(const Medium& medium, int level, double degrees) {
  const auto side = static_cast<float>(wall_side), angle = glm::radians(static_cast<float>(degrees));
  const float cell = std::exp2(float(level)), distance = 0.2f * side;
  const glm::vec3 direction(std::cos(angle), std::sin(angle), 0.0f),
      middle(0.5f * side + 0.5f, 0.5f * side, 0.5f * side);
  return 1.0 - double(march(medium, middle - distance * direction, direction, 0.5f * cell / distance, {}, {}).opacity);
}

Series theory_by_angle(int level, const std::string& title) {
  Series series{title, ChartStyle::dashes};
  for (int degrees = 0; degrees <= 85; degrees += 5)
    series.points.push_back(chart_point(double(degrees), predicted_leak(level, 1, degrees)));
  return series;
}

/// Measured points of a level or a thickness, chosen from the table, beside theory's.
void add_pair(Chart& chart, const Table& table, const std::string& x, const std::string& label,
              const std::pair<std::string, double>& where) {
  chart.series.push_back(curve(table, x, "directional", "as published, " + label, ChartStyle::points, where));
  chart.series.push_back(
      theory_curve(table, x, "directional_theory", "theory, " + label, "as published, " + label, where));
}

/// The least angle over the levels from which a wall of one voxel lets 1 % through.
double breaking_angle(const Table& by_angle, const std::string& column) {
  double least = 90.0;
  for (const int level : levels) {
    const Series leak = curve(by_angle, "angle", column, "", ChartStyle::points, {"level", level});
    least = -worst_of({-least, -breaks_at(leak.points, weber_low)});
  }
  return least;
}

Chart angle_chart(const Table& by_angle) {
  Chart chart{"stability_leak_angle",
              "Leak of a wall of one voxel by the angle to its normal",
              {"angle / degrees", false, 0.0, 90.0},
              leak_axis};
  for (const int level : {1, 2, 4}) {
    const std::string name = fmt::format("as published, level {}", level);
    chart.series.push_back(curve(by_angle, "angle", "directional", name, ChartStyle::points, {"level", level}));
    chart.series.push_back(theory_by_angle(level, fmt::format("theory, level {}", level)));
    chart.series.back().color_of = name;
  }
  chart.series.push_back(
      curve(by_angle, "angle", "by_area", "cos^2 + sin^2 2^{-k}, level 4", ChartStyle::dashes, {"level", 4}));
  chart.series.push_back(
      curve(by_angle, "angle", "extinction", "extinction, level 4", ChartStyle::line_points, {"level", 4}));
  chart.marks = {{breaking_angle(by_angle, "directional"), "published: 1 %"},
                 {breaking_angle(by_angle, "extinction"), "extinction: 1 %"}};
  return chart;
}

Chart level_chart(const Table& by_angle) {
  Chart chart{"stability_leak_level",
              "Leak of a wall of one voxel by the level of its texel",
              {"level", false, 0.5, 4.5},
              leak_axis};
  chart.series.push_back(curve(by_angle, "level", "isotropic", "isotropic", ChartStyle::points, {"angle", 0}));
  chart.series.push_back(
      theory_curve(by_angle, "level", "isotropic_theory", "theory, isotropic", "isotropic", {"angle", 0}));
  for (const int degrees : {45, 75})
    add_pair(chart, by_angle, "level", fmt::format("{} degrees", degrees), {"angle", degrees});
  chart.series.push_back(
      curve(by_angle, "level", "by_area", "cos^2 + sin^2 2^{-k}, 75 degrees", ChartStyle::dashes, {"angle", 75}));
  chart.series.push_back(
      curve(by_angle, "level", "extinction", "extinction, 75 degrees", ChartStyle::line_points, {"angle", 75}));
  return chart;
}

Chart thickness_chart(const Table& by_thickness) {
  Chart chart{"stability_leak_thickness",
              "Leak of a wall in a texel of 8 voxels by its thickness",
              {"thickness / voxels", false, 0.0, 8.5},
              leak_axis};
  for (const int degrees : {45, 75})
    add_pair(chart, by_thickness, "thickness", fmt::format("{} degrees", degrees), {"angle", degrees});
  chart.series.push_back(
      curve(by_thickness, "thickness", "extinction", "extinction, 75 degrees", ChartStyle::line_points, {"angle", 75}));
  return chart;
}

Table leak_table() {
  return {"stability_leak_level",
          "Light that a wall lets through",
          {{"thickness", "voxels"},
           {"level", ""},
           {"angle", "degrees"},
           {"isotropic", ""},
           {"isotropic_theory", ""},
           {"directional", ""},
           {"directional_theory", ""},
           {"by_area", ""},
           {"extinction", ""}}};
}

/// What is worst of the rows.
struct LeakExtremes {
  double steep = 0.0, grazing = 0.0;  ///< leak of extinction to 75 degrees, and beyond
  double off = 0.0, off_area = 0.0;   ///< of the published read from theory, and from the formula by area
};

void measure_leaks(int thickness, std::span<const int> of_levels, int angle_step, Table& table, LeakExtremes& worst) {
  const RawVolume directional(wall_pyramid(wall_side, thickness, 1.0f)),
      isotropic(wall_pyramid(wall_side, thickness, 1.0f, MipmapFilter::isotropic));
  const Medium medium = make_medium(wall_pyramid(wall_side, thickness, 1.0f));
  for (const int level : of_levels)
    for (int degrees = 0; degrees <= 85; degrees += angle_step) {
      const double predicted = predicted_leak(level, thickness, degrees),
                   by_area = leak_by_area(level, thickness, degrees),
                   plain_theory = 1.0 - std::min(1.0, thickness * std::exp2(-level)),
                   seen = 1.0 - published_opacity(directional, level, degrees),
                   plain = 1.0 - published_opacity(isotropic, level, degrees),
                   marched = extinction_leak(medium, level, degrees);
      table.add(
          {double(thickness), double(level), double(degrees), plain, plain_theory, seen, predicted, by_area, marched});
      double& extreme = degrees <= steepest ? worst.steep : worst.grazing;
      extreme = worst_of({extreme, marched});
      worst.off = worst_of({worst.off, std::abs(seen - predicted), std::abs(plain - plain_theory)});
      worst.off_area = worst_of({worst.off_area, std::abs(seen - by_area)});
    }
}

}  // namespace

Failure leak_by_level() {
  LeakExtremes worst;
  Table by_angle = leak_table(), by_thickness = leak_table();
  measure_leaks(1, levels, 5, by_angle, worst);
  for (const int thickness : {1, 2, 3, 4, 6, 8}) measure_leaks(thickness, std::array{3}, 15, by_thickness, worst);
  Failure failure{
      "Leaks through a wall, by level, angle and thickness",
      fmt::format(
          "What the texel that holds a wall lets through. The isotropic mean of m voxels in a texel of 2^k has opacity "
          "m 2^-k. Directional volumes are read with dir_a^2 by the published cones, of which one sample is taken in "
          "the texel's middle: cos^2 + sin^2 e, where e is the wall's opacity edge-on. By its area alone e would be m "
          "2^-k as well, which is off by up to {:.2f} of what is measured (dashed in grey). What is missing there: "
          "texels behind each other are composited as if what they cover were independent, e' = mean of 1 - (1 - e)^2 "
          "over the two texels side by side, from e = 1 for a voxel of wall, 0 beside it; for one voxel (1 - (1 - "
          "e)^2) / 2. That is theory here, and what is measured must agree with it to {:g}.\n\nThe extinction that "
          "this program marches treats walls in texels behind each other as one (optical_depth.h); shown is what a "
          "cone lets through whose texels have that level at the wall. A leak counts from 1 % on: Weber's fraction of "
          "brightness is 1 to 2 %.",
          worst.off_area, leak_tolerance),
      by_angle,
      {angle_chart(by_angle), level_chart(by_angle), thickness_chart(by_thickness)}};
  failure.table.rows.insert(failure.table.rows.end(), by_thickness.rows.begin(), by_thickness.rows.end());
  failure.thresholds = {
      {"leak_extinction", worst.steep, "", "most that a marched cone lets through a wall, to 75 degrees"},
      {"leak_extinction_grazing", worst.grazing, "", "the same from 80 to 85 degrees"},
      {"leak_extinction_angle", breaking_angle(by_angle, "extinction"), "degrees",
       "from which a wall of one voxel lets 1 % of a marched cone through, at any level", Worse::smaller},
      {"leak_published_angle", breaking_angle(by_angle, "directional"), "degrees",
       "from which texels as the published cones read them let 1 % through", Worse::smaller},
      {"leak_theory_gap", worst.off, "", "most that a published sample's opacity is off the two formulas"},
      {"leak_area_gap", worst.off_area, "", "most that it is off the formula by area"}};
  return failure;
}

}  // namespace voxref
