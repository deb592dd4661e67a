// Light through the wall between two rooms.
#include <fmt/format.h>

#include "make_scenes/builders.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

Failure leak_between_rooms() {
  Failure failure{"Leaks between two rooms, by the thickness of their wall and its angle to the grid",
                  "A closed room cut in two by a wall, a lamp in one half: the other half is black. Shown is the mean "
                  "radiance of the dark half over that of the lit one, direct light at the voxels alone, for a room "
                  "that is aligned with the grid or turned; and for cones that read opacity raw, aligned.",
                  {"stability_leak_rooms",
                   "Dark half over lit half",
                   {{"angle", "degrees"}, {"thickness", "voxels"}, {"extinction", ""}, {"raw", ""}}}};
  constexpr int resolution = 48, width = 16;
  Settings settings = small_settings(resolution), raw_settings = settings;
  raw_settings.render.cone.opacity = ConeOpacity::raw;
  const auto leak = [](const Scene& scene, const Settings& read) {
    return TryTrace(scene, read, width, 1).mean() / TryTrace(scene, read, width, 0).mean();
  };
  double worst = 0.0, thick = 0.0, raw_worst = 0.0, needed = 0.0;
  for (const float degrees : {0.0f, 22.5f, 45.0f}) {
    const glm::mat3 turn = turn_about({1.0f, 2.0f, 3.0f}, degrees);
    const float voxel = fit_grid(placed(thin_wall(0.1f), turn, {}).bounds(), settings.grid).voxel;
    std::vector<ChartPoint> from_thick;
    for (const float voxels : {0.25f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f, 4.0f}) {
      const Scene scene = placed(thin_wall(voxels * voxel), turn, {});
      const double through = leak(scene, settings);
      Cell raw;
      if (degrees == 0.0f) {
        const double raw_through = leak(scene, raw_settings);
        raw = raw_through;
        raw_worst = worst_of({raw_worst, raw_through});
      }
      failure.table.add({double(degrees), double(voxels), through, raw});
      from_thick.insert(from_thick.begin(), chart_point(double(voxels), through));
      worst = worst_of({worst, through});
    }
    thick = worst_of({thick, from_thick.front().y});
    needed = worst_of({needed, breaks_at(from_thick, weber_low)});
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
  chart.series.push_back(level_line(weber_low, 0.25, 4.0, "1 %"));
  chart.marks = {{needed, "1 % and less"}};
  failure.charts.push_back(std::move(chart));
  failure.thresholds = {
      {"leak_rooms", worst, "", "most that a wall lets through, from a quarter of a voxel on, at any angle"},
      {"leak_rooms_break", needed, "voxels", "thickness below which a wall lets 1 % through, at any angle"},
      {"leak_rooms_thick", thick, "", "what four voxels let through"},
      {"leak_rooms_raw", raw_worst, "", "most that raw opacity lets through, aligned"}};
  return failure;
}

}  // namespace voxref
