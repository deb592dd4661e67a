// What it does that cones are few, round and wide.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compare/statistics.h"
#include "cone/march.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"
#include "voxel/mipmap.h"

namespace voxref {

Failure cone_bands() {
  Failure failure{
      "Bands of few wide cones",
      "A glowing ball over a black floor; light along a line on the floor over that in closed form, cos (r / d)^2. A "
      "cone that points at the ball sees it whole, between two cones neither does.",
      {"stability_cone_bands",
       "Light along a line on the floor over the true light",
       {{"cones", ""}, {"x", "m"}, {"ratio", ""}}}};
  GridOptions grid;
  grid.resolution = 64;
  const Medium medium = glowing_medium(floor_and_ball(0.0f), grid);
  Chart way{"stability_cone_bands",
            "A ball's light along a line on the floor",
            {"distance from below the ball / m"},
            {"gathered / true light", false, 0.0}};
  Series bands{"measured", ChartStyle::line_points};
  constexpr float end = 1.2f;
  for (const int cones : {4, 6, 16, 32, 64, 128, 256}) {
    Series ratio{fmt::format("{} cones", cones), ChartStyle::line_points};
    std::vector<double> ratios;
    constexpr int points = 49;
    for (int i = 0; i < points; ++i) {
      const glm::vec3 p(-end + 2.0f * end * float(i) / (points - 1), 0.0f, 0.07f);
      ratios.push_back(gathered(medium, p, {0.0f, 1.0f, 0.0f}, cones) / ball_light(p));
      failure.table.add({double(cones), double(p.x), ratios.back()});
      ratio.points.push_back(chart_point(double(p.x), ratios.back()));
    }
    const double amplitude = spread_over_mean(ratios);
    bands.points.push_back(chart_point(double(cones), amplitude, fmt::format("mean {:.2f}", mean(ratios))));
    if (cones == 6 || cones == 32 || cones == 128) {
      failure.thresholds.push_back({fmt::format("cone_bands_{}", cones), amplitude, "",
                                    "largest less smallest of the light over the true one, over its mean"});
      way.series.push_back(std::move(ratio));
    }
  }
  way.series.push_back(level_line(1.0, -double(end), double(end), "theory"));
  const std::vector<ChartPoint> from_many(bands.points.rbegin(), bands.points.rend());
  failure.thresholds.push_back(
      {"cone_bands_need", breaks_at(from_many, 0.25), "cones", "that bands of at most 25 % of the mean take"});
  failure.charts = {way,
                    {"stability_cone_bands_count",
                     "Bands by the number of cones",
                     {"cones", true},
                     {"(largest - smallest) / mean", false, 0.0},
                     {bands}}};
  return failure;
}

namespace {

/// A wall of radiance 1 on one side of an edge and 0 on the other, as a narrow to wide cone sees it.
constexpr int edge_side = 128;
constexpr float edge_distance = 8.0f;  // voxels from the cone's apex to the wall's front

Medium edge_medium(int first_bright) {
  const SurfaceGrid surfaces = wall(edge_side, 1, 1.0f);
  std::vector<glm::vec3> radiance;
  for (const glm::ivec3& v : surfaces.voxels) radiance.emplace_back(v.y >= first_bright ? 1.0f : 0.0f);
  return make_medium(mipmap(surfaces, radiance, {}));
}

/// Standard deviation of the edge's image, voxels: of the derivative of what a cone sees that is moved across.
double edge_width(const Medium& medium, int edge, float tangent) {
  // The coarser of two levels has texels of up to 2 d; their average and interpolation reach 1.5 texels to each side.
  constexpr int places = 64;  // to either side
  const float reach = 3.0f * std::max(1.0f, 2.0f * tangent * edge_distance), step = reach / places;
  double total = 0.0, first = 0.0, second = 0.0, before = 0.0;
  for (int i = -places; i <= places; ++i) {
    const float u = float(i) * step;
    const glm::vec3 origin(0.5f * edge_side - edge_distance, float(edge) + u, 0.5f * edge_side + 0.5f);
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
  return std::sqrt(std::max(0.0, second / total - first * first));
}

/// A texel of side n voxels holds the share f of the bright half; interpolation between texels' centres then rises by f
/// around its one border and by 1 - f around the other, each over a box of n: variance n^2 / 12 + n^2 f (1 - f) about
/// the edge itself. Over the n places that the edge can take, f (1 - f) has the mean (n^2 - 1) / (6 n^2), so
///
///   variance = n^2 / 4 - 1 / 6,
///
/// and between two levels what is mixed linearly in the side. The true disc has variance d^2 / 16.
double predicted_width(double diameter) {
  const double side = std::max(diameter, 1.0), fine = std::exp2(std::floor(std::log2(side))), share = side / fine - 1.0;
  const auto variance = [](double n) { return n * n / 4.0 - 1.0 / 6.0; };
  return std::sqrt((1.0 - share) * variance(fine) + share * variance(2.0 * fine));
}

}  // namespace

Failure specular_blur() {
  Failure failure{
      "Specular over-blur",
      fmt::format(
          "A bright and a dark half of a wall, {:g} voxels in front of a cone that moves across their edge; the "
          "standard "
          "deviation of what it sees of the edge, mean over 16 places of the edge in the grid. A disc of the cone's "
          "diameter d blurs by d / 4. Texels of side n, averaged and interpolated, blur by sqrt(n^2 / 4 - 1 / 6): "
          "twice "
          "as much where n = d, and 0.29 voxels by the finest, however narrow the cone is. That is theory here, with "
          "two levels mixed in between.",
          edge_distance),
      {"stability_specular_blur",
       "Blur of an edge",
       {{"half_angle", "degrees"},
        {"diameter", "voxels"},
        {"blur", "voxels"},
        {"theory", "voxels"},
        {"true", "voxels"},
        {"ratio", ""}}}};
  struct Placed {
    int edge;
    Medium medium;
  };
  std::vector<Placed> edges;
  constexpr int places = 16;
  for (int i = 0; i < places; ++i) {
    const int edge = edge_side / 2 - places / 2 + i;
    edges.push_back({edge, edge_medium(edge)});
  }
  std::vector<ChartPoint> from_wide;
  double off = 0.0;
  for (const double degrees : {0.5, 1.0, 2.0, 5.0, 9.0, 15.0, 20.0, 27.0, 35.0, 45.0}) {
    const double tangent = std::tan(degrees * std::numbers::pi / 180.0),
                 diameter = 2.0 * tangent * double(edge_distance);
    double squares = 0.0;
    for (const Placed& placed : edges) {
      const double width = edge_width(placed.medium, placed.edge, static_cast<float>(tangent));
      squares += width * width / places;
    }
    const double blur = std::sqrt(squares), theory = predicted_width(diameter), truth = diameter / 4.0;
    failure.table.add({degrees, diameter, blur, theory, truth, blur / truth});
    from_wide.insert(from_wide.begin(), chart_point(degrees, blur / truth));
    off = worst_of({off, std::abs(blur / theory - 1.0)});
    if (degrees == 9.0 || degrees == 27.0 || degrees == 45.0)
      failure.thresholds.push_back({fmt::format("specular_blur_{:g}", degrees), blur / truth, "",
                                    "blur of an edge over that of the cone's own disc"});
  }
  failure.charts.push_back({"stability_specular_blur",
                            fmt::format("Blur of an edge at {:g} voxels", edge_distance),
                            {"half-angle / degrees", true},
                            {"standard deviation / voxels", true},
                            {curve(failure.table, "half_angle", "blur", "measured"),
                             theory_curve(failure.table, "half_angle", "theory", "theory, texels", "measured"),
                             curve(failure.table, "half_angle", "true", "truth, a disc", ChartStyle::dashes)}});
  failure.thresholds.push_back({"specular_blur_break", breaks_at(from_wide, 3.0), "degrees",
                                "half-angle below which the blur is over three times the cone's own"});
  failure.thresholds.push_back({"specular_blur_theory_gap", off, "", "most that the blur is off theory, relative"});
  return failure;
}

namespace {

struct Set {
  std::string name;
  std::vector<Cone> cones;
  double factor;  ///< on L = cos, of spec section 8; NaN: none given
};

std::vector<Set> cone_sets() {
  std::vector<Set> sets = {{"villegas4", villegas4_cones(), 1.189}, {"villegas6", villegas6_cones(), 1.143}};
  for (const int count : {4, 6, 9, 16, 32, 64, 128, 256})
    sets.push_back({std::to_string(count), partition_hemisphere(count), std::nan("")});
  return sets;
}

double cos_half_angle(const Cone& cone) { return 1.0 / std::hypot(1.0, double(cone.tan_half_angle)); }

/// Share of a square that a circle of the same area about its middle leaves out: four segments of the circle stick out
/// at its sides, each r^2 (a - sin a cos a) with cos a = (1/2) / r and pi r^2 = 1.
double square_gap() {
  const double r = std::sqrt(std::numbers::inv_pi), a = std::acos(0.5 / r);
  return 4.0 * r * r * (a - std::sin(a) * std::cos(a));
}

}  // namespace

Failure cone_gaps() {
  Failure failure{
      "Gaps and overlaps of cones",
      fmt::format(
          "Radiance that falls with the cosine, L = cos, as each cone's own mean, cos (1 + cos a) / 2 at half-angle a, "
          "over the true irradiance 2 pi / 3; and the share of the hemisphere that is inside a cone, and inside two. "
          "Round cones of square cells of the same solid angle leave {:.3f} out, four segments of a circle, and "
          "overlap "
          "with their neighbours by as much. Of any set the shares inside one and inside two add up to at most the "
          "cones' own solid angle, which is less than the hemisphere for the published sets.",
          square_gap()),
      {"stability_cones",
       "Cone sets: light that falls with the cosine, gaps and overlaps",
       {{"set", ""}, {"factor", ""}, {"theory", ""}, {"gap", ""}, {"overlap", ""}, {"solid_angle", "hemispheres"}}}};
  Chart light{"stability_cones", "Cone sets on L = cos", {"cones"}, {"gathered / true irradiance"}};
  Chart gaps{
      "stability_cone_gaps", "Gaps and overlaps of cone sets", {"cones"}, {"share of the hemisphere", false, 0.0}};
  Series factors{"measured", ChartStyle::points}, theory{"theory, published sets", ChartStyle::dashes};
  Series outside{"outside of all cones", ChartStyle::points}, twice{"inside two", ChartStyle::points};
  double worst = 0.0, off = 0.0, gap = 0.0, overlap = 0.0, gap_off = 0.0;
  for (const Set& set : cone_sets()) {
    double sum = 0.0, solid_angle = 0.0;
    for (const Cone& cone : set.cones) {
      sum += double(cone.weight) * double(cone.direction.z) * 0.5 * (1.0 + cos_half_angle(cone));
      solid_angle += 1.0 - cos_half_angle(cone);
    }
    const double factor = sum / (2.0 * std::numbers::pi / 3.0);
    const Coverage covers = coverage(set.cones);
    failure.table.add({set.name, factor, set.factor, 1.0 - covers.covered, covers.overlap, solid_angle});
    const auto x = double(light.x.categories.size());
    factors.points.push_back(chart_point(x, factor, fmt::format("{:.3f}", factor)));
    theory.points.push_back(chart_point(x, set.factor));
    outside.points.push_back(chart_point(x, 1.0 - covers.covered, fmt::format("{:.3f}", 1.0 - covers.covered)));
    twice.points.push_back(chart_point(x, covers.overlap));
    for (Chart* chart : {&light, &gaps}) chart->x.categories.push_back(set.name);
    if (!std::isnan(set.factor)) {
      off = worst_of({off, std::abs(factor - set.factor)});
      continue;
    }
    worst = worst_of({worst, std::abs(factor - 1.0)});
    gap = worst_of({gap, 1.0 - covers.covered});
    overlap = worst_of({overlap, covers.overlap});
    if (set.cones.size() >= 128)
      gap_off =
          worst_of({gap_off, std::abs(1.0 - covers.covered - square_gap()), std::abs(covers.overlap - square_gap())});
  }
  const auto last = double(light.x.categories.size()) - 1.0;
  theory.color_of = factors.title;
  light.series = {factors, theory, level_line(1.0, 0.0, last, "theory, any partition")};
  gaps.series = {outside, twice, level_line(square_gap(), 0.0, last, "theory, square cells")};
  failure.charts = {light, gaps};
  failure.thresholds = {
      {"cone_factor", worst, "", "most that a partition's factor is off 1"},
      {"cone_factor_theory_gap", off, "", "how far the published sets are off 1.189 and 1.143"},
      {"cone_gap", gap, "", "most of the hemisphere that a partition's round cones leave out"},
      {"cone_overlap", overlap, "", "most of the hemisphere that is inside two of its cones"},
      {"cone_gap_theory_gap", gap_off, "", "how far gaps and overlaps of 128 cones and more are off those of squares"}};
  return failure;
}

}  // namespace voxref
