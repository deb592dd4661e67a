// Light through walls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "cone/march.h"
#include "make_scenes/builders.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

constexpr int wall_side = 64;

/// Opacity of the wall's texel at a level as the published cones read it: the faces weighted with dir_a^2.
double published_opacity(const Pyramid& pyramid, int level, double degrees) {
  const int texel = wall_side / 2 >> level;
  const DirectionalTexel& faces = pyramid.levels[size_t(level - 1)](glm::ivec3(texel));
  const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
  return c * c * double(faces[size_t(Face::pos_x)].a) + s * s * double(faces[size_t(Face::pos_y)].a);
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

}  // namespace

Failure leak_by_level() {
  Failure failure{
      "Leaks through a wall, by level, angle and thickness",
      "What the texel that holds a wall lets through. The isotropic mean of m voxels in a texel of 2^k has opacity m "
      "2^-k. Directional volumes are read with dir_a^2 by the published cones: cos^2 + sin^2 e, where e is the wall's "
      "opacity edge-on. Its area alone would make e the isotropic one; but texels behind each other are composited as "
      "if what they cover were independent: e' = mean of 1 - (1 - e)^2 over the two texels side by side, from e = 1 "
      "for "
      "a voxel of wall, 0 beside it; for one voxel (1 - (1 - e)^2) / 2. That is theory here.\n\nThe extinction that "
      "this program marches treats walls in texels behind each other as one (optical_depth.h); shown is what a cone "
      "lets through whose texels have that level at the wall.",
      {"stability_leak_level",
       "Light that a wall lets through",
       {{"thickness", "voxels"},
        {"level", ""},
        {"angle", "degrees"},
        {"isotropic", ""},
        {"isotropic_theory", ""},
        {"directional", ""},
        {"directional_theory", ""},
        {"extinction", ""}}}};
  double worst = 0.0, off = 0.0;
  const auto measure = [&](int thickness, const std::vector<int>& levels, int angle_step) {
    const Pyramid directional = wall_pyramid(wall_side, thickness, 1.0f),
                  isotropic = wall_pyramid(wall_side, thickness, 1.0f, MipmapFilter::isotropic);
    const Medium medium = make_medium(wall_pyramid(wall_side, thickness, 1.0f));
    for (const int level : levels)
      for (int degrees = 0; degrees <= 85; degrees += angle_step) {
        const double fraction = std::min(1.0, thickness * std::exp2(-level));
        const double predicted = predicted_leak(level, thickness, degrees);
        const double seen = 1.0 - published_opacity(directional, level, degrees);
        const double plain = 1.0 - published_opacity(isotropic, level, degrees);
        const double marched = extinction_leak(medium, level, degrees);
        failure.table.add(
            {double(thickness), double(level), double(degrees), plain, 1.0 - fraction, seen, predicted, marched});
        if (degrees <= 75) worst = worst_of({worst, marched});
        off = worst_of({off, std::abs(seen - predicted), std::abs(plain - 1.0 + fraction)});
      }
  };
  measure(1, {1, 2, 3, 4}, 5);
  const Table by_angle = failure.table;
  constexpr int fixed_level = 3;
  failure.table.rows.clear();
  for (const int thickness : {1, 2, 3, 4, 6, 8}) measure(thickness, {fixed_level}, 15);
  const Table by_thickness = failure.table;
  failure.table.rows.insert(failure.table.rows.begin(), by_angle.rows.begin(), by_angle.rows.end());

  const Axis leak{"transmitted / incident", false, 0.0};
  Chart angles{"stability_leak_angle",
               "Leak of a wall of one voxel by the angle to its normal",
               {"angle / degrees", false, 0.0, 90.0},
               leak};
  for (const int level : {1, 2, 4}) {
    angles.series.push_back(curve(by_angle, "angle", "directional", fmt::format("as published, level {}", level),
                                  ChartStyle::points, {"level", level}));
    angles.series.push_back(theory_by_angle(level, fmt::format("theory, level {}", level)));
    angles.series.back().color_of = fmt::format("as published, level {}", level);
  }
  angles.series.push_back(
      curve(by_angle, "angle", "extinction", "extinction, level 4", ChartStyle::line_points, {"level", 4}));
  Chart levels{"stability_leak_level",
               "Leak of a wall of one voxel by the level of its texel",
               {"level", false, 0.5, 4.5},
               leak};
  levels.series.push_back(curve(by_angle, "level", "isotropic", "isotropic", ChartStyle::points, {"angle", 0}));
  levels.series.push_back(
      theory_curve(by_angle, "level", "isotropic_theory", "theory, isotropic", "isotropic", {"angle", 0}));
  for (const int degrees : {45, 75})
    add_pair(levels, by_angle, "level", fmt::format("{} degrees", degrees), {"angle", degrees});
  levels.series.push_back(
      curve(by_angle, "level", "extinction", "extinction, 75 degrees", ChartStyle::line_points, {"angle", 75}));
  Chart thicknesses{"stability_leak_thickness",
                    "Leak of a wall in a texel of 8 voxels by its thickness",
                    {"thickness / voxels", false, 0.0, 8.5},
                    leak};
  for (const int degrees : {45, 75})
    add_pair(thicknesses, by_thickness, "thickness", fmt::format("{} degrees", degrees), {"angle", degrees});
  thicknesses.series.push_back(
      curve(by_thickness, "thickness", "extinction", "extinction, 75 degrees", ChartStyle::line_points, {"angle", 75}));
  failure.charts = {angles, levels, thicknesses};

  constexpr double leaky = 0.01;
  const auto breaking_angle = [&](const std::string& column) {
    double least = 90.0;
    for (const int level : {1, 2, 3, 4})
      least = -worst_of(
          {-least,
           -breaks_at(curve(by_angle, "angle", column, "", ChartStyle::points, {"level", level}).points, leaky)});
    return least;
  };
  failure.thresholds = {
      {"leak_extinction", worst, "", "most that a marched cone lets through a wall, to 75 degrees"},
      {"leak_extinction_angle", breaking_angle("extinction"), "degrees",
       "from which a wall of one voxel lets 1 % of a marched cone through, at any level", Worse::smaller},
      {"leak_published_angle", breaking_angle("directional"), "degrees",
       "from which texels as the published cones read them let 1 % through", Worse::smaller},
      {"leak_theory_gap", off, "", "most that the filtered opacity is off the two formulas"}};
  return failure;
}

Failure leak_between_rooms() {
  Failure failure{"Leaks between two rooms, by the thickness of their wall and its angle to the grid",
                  "A closed room cut in two by a wall, a lamp in one half: the other half is black. Shown is the mean "
                  "radiance of the dark half over that of the lit one, direct light at the voxels alone, for a room "
                  "that is aligned with the grid or turned; and for cones that read opacity raw, aligned.",
                  {"stability_leak_rooms",
                   "Dark half over lit half",
                   {{"angle", "degrees"}, {"thickness", "voxels"}, {"extinction", ""}, {"raw", ""}}}};
  constexpr int resolution = 48, width = 16;
  double worst = 0.0, thick = 0.0, raw_worst = 0.0;
  for (const float degrees : {0.0f, 22.5f, 45.0f}) {
    const glm::mat3 turn = turn_about({1.0f, 2.0f, 3.0f}, degrees);
    const Settings settings = small_settings(resolution);
    const float voxel = fit_grid(placed(thin_wall(0.1f), turn, {}).bounds(), settings.grid).voxel;
    const auto leak = [&](const Scene& scene, ConeOpacity opacity) {
      Settings read = settings;
      read.render.cone.opacity = opacity;
      return mean_luminance(trace(scene, read, width, 1)) / mean_luminance(trace(scene, read, width, 0));
    };
    for (const float voxels : {0.25f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f, 4.0f}) {
      const Scene scene = placed(thin_wall(voxels * voxel), turn, {});
      const double through = leak(scene, ConeOpacity::extinction);
      const double raw = degrees == 0.0f ? leak(scene, ConeOpacity::raw) : std::nan("");
      failure.table.add({double(degrees), double(voxels), through, raw});
      worst = worst_of({worst, through});
      if (voxels == 4.0f) thick = worst_of({thick, through});
      if (degrees == 0.0f) raw_worst = worst_of({raw_worst, raw});
    }
  }
  Chart chart{"stability_leak_rooms",
              "Light behind a wall",
              {"thickness / voxels", false, 0.0},
              {"dark half / lit half", true}};
  for (const double degrees : {0.0, 22.5, 45.0})
    chart.series.push_back(curve(failure.table, "thickness", "extinction",
                                 fmt::format("extinction, turned by {:g} degrees", degrees), ChartStyle::line_points,
                                 {"angle", degrees}));
  chart.series.push_back(curve(failure.table, "thickness", "raw", "raw opacity, aligned"));
  failure.charts.push_back(std::move(chart));
  failure.thresholds = {
      {"leak_rooms", worst, "", "most that a wall lets through, from a quarter of a voxel on, at any angle"},
      {"leak_rooms_thick", thick, "", "what four voxels let through"},
      {"leak_rooms_raw", raw_worst, "", "most that raw opacity lets through, aligned"}};
  return failure;
}

}  // namespace voxref
