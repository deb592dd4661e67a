// How wide a narrow cone's texels blur.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cone/march.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"
#include "voxel/mipmap.h"

namespace voxref {

namespace {

/// A wall of radiance 1 on one side of an edge and 0 on the other, as a narrow to wide cone sees it.
constexpr int edge_side = 128;
constexpr int edge_places = 16;  // of the edge in the grid: all that a texel of 16 voxels knows

Medium edge_medium(int first_bright) {
  const SurfaceGrid surfaces = wall(edge_side, 1, 1.0f);
  std::vector<glm::vec3> radiance;
  for (const glm::ivec3& v : surfaces.voxels) radiance.emplace_back(v.y >= first_bright ? 1.0f : 0.0f);
  return make_medium(mipmap(surfaces, radiance, {}));
}

/// Standard deviation of the edge's image, voxels: of the derivative of what a cone sees that is moved across.
/// @param distance from the cone's apex to the wall's front, voxels
double edge_width(const Medium& medium, int edge, float tangent, float distance) {
  // The coarser of two levels has texels of up to 2 d; their average and interpolation reach 1.5 texels to each side.
  constexpr int places = 64;  // to either side
  const float reach = 3.0f * std::max(1.0f, 2.0f * tangent * distance), step = reach / places;
  double total = 0.0, first = 0.0, second = 0.0, before = 0.0;
  for (int i = -places; i <= places; ++i) {
    const float u = float(i) * step;
    const glm::vec3 origin(0.5f * edge_side - distance, float(edge) + u, 0.5f * edge_side + 0.5f);
    const auto seen = double(march(medium, origin, {1.0f, 0.0f, 0.0f}, tangent, {}, {}).radiance.r);
    if (i > -places) {
      const double share = seen - before, middle = double(u) - 0.5 * double(step);
      total += share;
      first += share * middle;
      second += share * middle * middle;
    }
    before = seen;
  }
  first /= total;
  return std::sqrt(second / total - first * first);
}

/// The wall's edges, each at its own place in the grid.
class Edges {
 public:
  Edges() {
    for (int i = 0; i < edge_places; ++i) {
      places_.push_back(edge_side / 2 - edge_places / 2 + i);
      media_.push_back(edge_medium(places_.back()));
    }
  }
  /// Root of the mean variance.
  double width(float tangent, float distance) const {
    double squares = 0.0;
    for (size_t i = 0; i < media_.size(); ++i) {
      const double width = edge_width(media_[i], places_[i], tangent, distance);
      squares += width * width / edge_places;
    }
    return std::sqrt(squares);
  }

 private:
  std::vector<int> places_;
  std::vector<Medium> media_;
};

/// A texel of side n voxels holds the share f of the bright half; interpolation between texels' centres then rises by f
/// around its one border and by 1 - f around the other, each over a box of n: variance n^2 / 12 + n^2 f (1 - f) about
/// the edge itself. Over the n places that the edge can take, f (1 - f) has the mean (n^2 - 1) / (6 n^2), so
///
///   variance = n^2 / 4 - 1 / 6,
///
/// and between two levels both, mixed by log2 of the side: the level that the march reads is log2 of the texel's side,
/// and between whole levels it interpolates linearly in the level. The true disc has variance d^2 / 16.
/// @param share of the coarser level, by the side over the finer one's, in [1,2)
double predicted_width(double diameter, double (*share)(double side_over_fine)) {
  const double side = std::max(diameter, 1.0), fine = std::exp2(std::floor(std::log2(side))),
               coarse = share(side / fine);
  const auto variance = [](double n) { return n * n / 4.0 - 1.0 / 6.0; };
  return std::sqrt((1.0 - coarse) * variance(fine) + coarse * variance(2.0 * fine));
}

double mixed_by_log(double side) { return std::log2(side); }
/// What the march does not do. It counts less of the coarser level, and so at 8 voxels comes nearer than log2 by
/// chance: texels that reach in front of the wall are seen where the cone is narrower.
double mixed_linearly(double side) { return side - 1.0; }

constexpr double near = 8.0, far = 56.0;  ///< distances of the apex from the wall, voxels

/// One blur beside both theories' gaps.
struct Blur {
  double ratio;            ///< to the cone's own disc
  double off, off_linear;  ///< theory, relative: as the march mixes, and mixed linearly
};

Blur add_blur(Table& table, const Edges& edges, double distance, double tangent) {
  const double diameter = 2.0 * tangent * distance, theory = predicted_width(diameter, mixed_by_log),
               linear = predicted_width(diameter, mixed_linearly), truth = diameter / 4.0,
               blur = edges.width(static_cast<float>(tangent), static_cast<float>(distance));
  const double degrees = std::atan(tangent) * 180.0 / std::numbers::pi;
  table.add({distance, degrees, diameter, blur, theory, truth, blur / truth});
  return {blur / truth, std::abs(blur / theory - 1.0), std::abs(blur / linear - 1.0)};
}

/// @param narrowest half-angle to mark, degrees
Chart blur_chart(const Table& table, double narrowest) {
  Chart chart{"stability_specular_blur",
              "Blur of an edge by the cone's diameter there",
              {"diameter / voxels", true},
              {"standard deviation / voxels", true}};
  for (const double distance : {near, far})
    chart.series.push_back(curve(table, "diameter", "blur", fmt::format("measured at {:g} voxels", distance),
                                 ChartStyle::points, {"distance", distance}));
  chart.series.push_back(
      theory_curve(table, "diameter", "theory", "theory, texels", chart.series.back().title, {"distance", far}));
  chart.series.push_back(curve(table, "diameter", "true", "truth, a disc", ChartStyle::dashes, {"distance", far}));
  chart.marks = {{2.0 * near * std::tan(narrowest * std::numbers::pi / 180.0), "3 times as wide"}};
  return chart;
}

}  // namespace

Failure specular_blur() {
  Failure failure{"Specular over-blur",
                  "",
                  {"stability_specular_blur",
                   "Blur of an edge",
                   {{"distance", "voxels"},
                    {"half_angle", "degrees"},
                    {"diameter", "voxels"},
                    {"blur", "voxels"},
                    {"theory", "voxels"},
                    {"true", "voxels"},
                    {"ratio", ""}}}};
  const Edges edges;
  std::vector<ChartPoint> from_wide;
  double off_near = 0.0, off_linear = 0.0, off_far = 0.0;
  for (const double degrees : {0.5, 1.0, 2.0, 5.0, 9.0, 15.0, 20.0, 27.0, 35.0, 45.0}) {
    const Blur blur = add_blur(failure.table, edges, near, std::tan(degrees * std::numbers::pi / 180.0));
    from_wide.insert(from_wide.begin(), chart_point(degrees, blur.ratio));
    off_near = worst_of({off_near, blur.off});
    off_linear = worst_of({off_linear, blur.off_linear});
    if (degrees == 9.0 || degrees == 27.0 || degrees == 45.0)
      failure.thresholds.push_back({fmt::format("specular_blur_{:g}", degrees), blur.ratio, "",
                                    "blur of an edge at 8 voxels over that of the cone's own disc"});
  }
  for (const double diameter : {0.25, 0.5, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.2, 16.0})
    off_far = worst_of({off_far, add_blur(failure.table, edges, far, diameter / (2.0 * far)).off});
  failure.text = fmt::format(
      "A bright and a dark half of a wall, in front of a cone that moves across their edge; the standard deviation of "
      "what it sees of the edge, mean over {} places of the edge in the grid. A disc of the cone's diameter d blurs by "
      "d / 4. Texels of side n, averaged and interpolated, blur by sqrt(n^2 / 4 - 1 / 6): twice as much where n = d, "
      "and 0.29 voxels by the finest, however narrow the cone is. That is theory here, with the variances of two "
      "levels mixed in between by log2 d, as the march mixes levels. It knows one diameter, that at the wall's front; "
      "but texels reach in front of the wall and behind it, and the cone goes on widening there. So the blur agrees "
      "with theory to {:.1f} % at {:g} voxels from the apex, and to {:.1f} % at {:g}. Theory that mixed linearly in d "
      "would be off by {:.1f} % there, nearer, but by chance: it counts less of the coarser level than the march, "
      "which stands in for the texels in front of the wall, where the cone is narrower.",
      edge_places, 100.0 * off_far, far, 100.0 * off_near, near, 100.0 * off_linear);
  // Texels as wide as the cone blur twice as much as it does; at three times it is the finest voxels that decide.
  const double narrowest = breaks_at(from_wide, 3.0);
  failure.charts = {blur_chart(failure.table, narrowest)};
  const std::vector<Threshold> more = {
      {"specular_blur_break", narrowest, "degrees",
       "half-angle below which the blur at 8 voxels is over three times the cone's own"},
      {"specular_blur_theory_gap", off_far, "", "most that the blur is off theory at 56 voxels, relative"},
      {"specular_blur_near_gap", off_near, "", "the same at 8 voxels"},
      {"specular_blur_linear_gap", off_linear, "", "the same at 8 voxels, of theory that mixes levels linearly"}};
  failure.thresholds.insert(failure.thresholds.end(), more.begin(), more.end());
  return failure;
}

}  // namespace voxref
