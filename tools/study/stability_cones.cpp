// What it does that cones are few, wide and made of texels.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "compare/statistics.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

/// Light that points along a line on the floor gather of a ball over it, over the true light.
struct Line {
  std::vector<double> places, ratios;  ///< metres from below the ball
};

Line light_along_floor(const Medium& medium, int cones, int points) {
  constexpr float end = 1.2f;
  Line line;
  for (int i = 0; i < points; ++i) {
    const glm::vec3 p(-end + 2.0f * end * float(i) / float(points - 1), 0.0f, 0.07f);
    line.places.push_back(double(p.x));
    line.ratios.push_back(gathered(medium, p, {0.0f, 1.0f, 0.0f}, cones) / ball_light(p));
  }
  return line;
}

Medium ball_medium(int resolution) {
  GridOptions grid;
  grid.resolution = resolution;
  return glowing_medium(floor_and_ball(0.0f), grid);
}

}  // namespace

Failure cone_bands() {
  Failure failure{"Bands of few wide cones",
                  "",
                  {"stability_cone_bands",
                   "Light along a line on the floor over the true light",
                   {{"cones", ""}, {"x", "m"}, {"ratio", ""}}}};
  const Medium medium = ball_medium(64);
  Chart way{"stability_cone_bands",
            "A ball's light along a line on the floor",
            {"distance from below the ball / m"},
            {"gathered / true light", false, 0.0}};
  Series bands{"largest - smallest", ChartStyle::line_points}, means{"mean", ChartStyle::line_points};
  std::vector<ChartPoint> from_many;
  for (const int cones : {4, 6, 16, 32, 64, 128, 256}) {
    const Line line = light_along_floor(medium, cones, 49);
    Series ratio{fmt::format("{} cones", cones), ChartStyle::line_points};
    for (size_t i = 0; i < line.places.size(); ++i) {
      failure.table.add({double(cones), line.places[i], line.ratios[i]});
      ratio.points.push_back(chart_point(line.places[i], line.ratios[i]));
    }
    const double amplitude = spread_over_mean(line.ratios), middle = mean(line.ratios);
    bands.points.push_back(chart_point(double(cones), amplitude));
    means.points.push_back(chart_point(double(cones), middle));
    from_many.insert(from_many.begin(), chart_point(double(cones), amplitude));
    if (cones != 6 && cones != 32 && cones != 128) continue;
    failure.thresholds.push_back({fmt::format("cone_bands_{}", cones), amplitude, "",
                                  "largest less smallest of the light over the true one, over its mean"});
    failure.thresholds.push_back({fmt::format("cone_light_{}", cones), std::abs(middle - 1.0), "",
                                  "how far that mean itself is off the true light, relative"});
    way.series.push_back(std::move(ratio));
  }
  way.series.push_back(level_line(1.0, -1.2, 1.2, "theory"));
  constexpr double quarter = 0.25;  // the roundest that up to 256 cones reach
  failure.thresholds.push_back(
      {"cone_bands_need", breaks_at(from_many, quarter), "cones", "that bands of at most 25 % of the mean take"});
  failure.text = fmt::format(
      "A glowing ball over a black floor; light along a line on the floor over that in closed form, cos (r / d)^2. A "
      "cone that points at the ball sees it whole, between two cones neither does: bands, shown over their mean. The "
      "mean is wrong too: {:.2f} times the true light with 6 cones, {:.2f} with 256. A cone's texels are as wide as it "
      "is, and one that holds a part of the ball is nearly opaque all over: to wide cones the ball is larger than it "
      "is. What is left with many cones, the next curve shows.",
      value_at(means, 6.0), value_at(means, 256.0));
  failure.charts = {way,
                    {"stability_cone_bands_count",
                     "Bands and mean by the number of cones",
                     {"cones", true},
                     {"bands over their mean; mean / true light", false, 0.0},
                     {bands, means}}};
  failure.charts.back().series.push_back(level_line(1.0, 4.0, 256.0, "true light"));
  failure.charts.back().marks = {{breaks_at(from_many, quarter), "bands of 25 %"}};
  return failure;
}

// The voxels that hold a part of a surface end beyond it: along an axis by half a voxel in the mean, and along a
// direction at an angle to the axes by half its 1-norm, which is 3/2 in the mean over directions. The interpolation
// between texels reaches as far again, and at an extinction of 9 per voxel its tail is nearly opaque too: together
// about
//
//   2 x 1/2 x 3/2 = 3/2 voxels.
//
// Less where a ball of few voxels ends in the thin of the tail; more where voxels are so small that even 1024 cones are
// wider than one at the ball (1.4 voxels at the finest), since their texels are then a mix with those of two voxels.
Failure emitter_growth() {
  Failure failure{"Growth of emitters by their voxels",
                  "",
                  {"stability_growth",
                   "A ball's light on the floor, by the voxels that its radius has",
                   {{"cones", ""}, {"radius", "voxels"}, {"ratio", ""}, {"growth", "voxels"}}}};
  Chart light{"stability_growth",
              "A ball's light on the floor by its radius",
              {"radius / voxels", true},
              {"gathered / true light, mean", false, 0.0}};
  constexpr double growth_theory = 1.5;
  double growth = 0.0, off = 0.0;
  for (const int cones : {64, 1024}) {
    Series ratios{fmt::format("{} cones", cones), ChartStyle::line_points};
    for (const int resolution : {24, 32, 48, 64, 96, 128}) {
      const Medium medium = ball_medium(resolution);
      const double radius = double(ball_radius) / double(medium.texels.grid.voxel),
                   ratio = mean(light_along_floor(medium, cones, 13).ratios), grown = radius * (std::sqrt(ratio) - 1.0);
      failure.table.add({double(cones), radius, ratio, grown});
      ratios.points.push_back(chart_point(radius, ratio));
      if (cones != 1024) continue;
      growth = worst_of({growth, grown});
      off = worst_of({off, std::abs(grown - growth_theory)});
    }
    light.series.push_back(std::move(ratios));
  }
  const std::vector<ChartPoint> fine = light.series.back().points;
  Series theory{"theory, a ball larger by 1.5 voxels", ChartStyle::dashes};
  std::vector<ChartPoint> from_large;
  for (const ChartPoint& point : fine) {
    const double grown = 1.0 + growth_theory / point.x;
    theory.points.push_back(chart_point(point.x, grown * grown));
    from_large.insert(from_large.begin(), chart_point(point.x, std::abs(point.y - 1.0)));
  }
  constexpr double half = 0.5;  // beyond, more light comes from the growth than half of what is true
  failure.text = fmt::format(
      "The same ball gathered by many narrow cones, mean over the line. The voxels that hold a part of it end beyond "
      "it, and interpolation reaches further still: by about 3/2 voxels, which is theory here. Measured is {:.2f} at "
      "the most, and {:.2f} off theory at the most, below it: the tail of the interpolation is not quite opaque. Wider "
      "cones, whose texels are larger than voxels, add to that; of 1024 cones it is what exceeds 3/2, where they are "
      "wider at the ball than its finest voxels.",
      growth, off);
  failure.thresholds = {
      {"growth", growth, "voxels", "most that an emitter's radius seems larger to 1024 cones"},
      {"growth_theory_gap", off, "voxels", "most that this is off 3/2"},
      {"growth_break", breaks_at(from_large, half), "voxels", "radius below which its light is off by half and more"}};
  theory.color_of = light.series.back().title;
  light.series.push_back(std::move(theory));
  light.series.push_back(level_line(1.0, fine.front().x, fine.back().x, "true light"));
  light.marks = {{breaks_at(from_large, half), "off by half"}};
  failure.charts = {light};
  return failure;
}

}  // namespace voxref
