// Failures of voxels and cones themselves, on volumes of known shape.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "cone/march.h"
#include "make_scenes/assemble.h"
#include "make_scenes/shapes.h"
#include "study/stability_curves.h"
#include "voxel/mipmap.h"

namespace voxref {

namespace {

/// A wall of one voxel across the middle of a cube of `side` unit voxels, x = side / 2 .. side / 2 + 1.
SurfaceGrid wall(int side, float opacity) {
  SurfaceGrid surfaces;
  surfaces.grid.size = glm::ivec3(side);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y) {
      surfaces.voxels.emplace_back(side / 2, y, z);
      surfaces.albedo.emplace_back(1.0f, 1.0f, 1.0f, opacity);
      surfaces.normal.emplace_back(-1.0f, 0.0f, 0.0f);
      surfaces.centroid.push_back(surfaces.grid.center(surfaces.voxels.back()));
    }
  return surfaces;
}

Pyramid wall_pyramid(int side, float opacity, MipmapFilter filter) {
  const SurfaceGrid surfaces = wall(side, opacity);
  return mipmap(surfaces, std::vector<glm::vec3>(surfaces.size(), glm::vec3(1.0f)), {filter});
}

/// Opacity of the wall's texel at a level as the published cones read it: the faces weighted with dir_a^2.
double published_opacity(const Pyramid& pyramid, int level, float degrees) {
  const int side = pyramid.grid.size.x, texel = side / 2 >> level;
  const DirectionalTexel& faces = pyramid.levels[size_t(level - 1)](glm::ivec3(texel));
  const double c = std::cos(glm::radians(double(degrees))), s = std::sin(glm::radians(double(degrees)));
  return c * c * double(faces[size_t(Face::pos_x)].a) + s * s * double(faces[size_t(Face::pos_y)].a);
}

/// Transmittance of a cone whose texels are those of `level` where it meets the wall at an angle to its normal.
double extinction_leak(const Medium& medium, int level, float degrees) {
  const auto side = static_cast<float>(medium.texels.grid.size.x);
  const float angle = glm::radians(degrees), cell = std::exp2(float(level)), distance = 0.2f * side;
  const glm::vec3 direction(std::cos(angle), std::sin(angle), 0.0f),
      middle(0.5f * side + 0.5f, 0.5f * side, 0.5f * side);
  return 1.0 - double(march(medium, middle - distance * direction, direction, 0.5f * cell / distance, {}, {}).opacity);
}

}  // namespace

Failure leak_by_level() {
  Failure failure{
      "Leaks through a wall of one voxel, by level and angle",
      "Opacity of the texel that holds the wall. The isotropic mean has 2^-k. Directional volumes are read with "
      "dir_a^2 by "
      "the published cones: cos^2 + sin^2 e_k, where e_k is the wall's opacity edge-on. 2^-k for e_k as well would "
      "count "
      "its area alone; but half of a texel's columns hold two texels behind each other, which are composited as if "
      "what "
      "they cover were independent: e_(k+1) = (1 - (1 - e_k)^2) / 2 from e_0 = 1, which is theory here.\n\nThe "
      "extinction that this program marches treats walls in texels behind each other as one (optical_depth.h); shown "
      "is "
      "what a cone lets through whose texels have that level at the wall.",
      {"stability_leak_level",
       "Light that a wall of one voxel lets through",
       {{"level", ""},
        {"angle", "degrees"},
        {"isotropic", ""},
        {"isotropic_theory", ""},
        {"directional", ""},
        {"directional_theory", ""},
        {"extinction", ""}},
       {}},
      {},
      {}};
  constexpr int side = 64;
  const Pyramid directional = wall_pyramid(side, 1.0f, MipmapFilter::anisotropic),
                isotropic = wall_pyramid(side, 1.0f, MipmapFilter::isotropic);
  const Medium medium = make_medium(wall_pyramid(side, 1.0f, MipmapFilter::anisotropic));
  double worst = 0.0, off = 0.0;
  Chart chart{"stability_leak_level",
              "Leak of a wall of one voxel, seen at an angle to its normal",
              {"level", false, {}, {}, {}},
              {"transmitted / incident", false, 0.0, 1.05, {}},
              {}};
  for (const float degrees : {0.0f, 45.0f, 75.0f}) {
    Series measured{fmt::format("directional, {:g} degrees", degrees), ChartStyle::points, {}};
    Series theory{"", ChartStyle::dashes, {}};
    Series extinction{fmt::format("extinction, {:g} degrees", degrees), ChartStyle::line_points, {}};
    double edge_on = 1.0;
    for (int level = 1; level <= 4; ++level) {
      edge_on = 0.5 * (1.0 - (1.0 - edge_on) * (1.0 - edge_on));
      const double fraction = std::exp2(-level), cosine = std::cos(glm::radians(double(degrees)));
      const double predicted = 1.0 - (cosine * cosine + (1.0 - cosine * cosine) * edge_on);
      const double seen = 1.0 - published_opacity(directional, level, degrees);
      const double plain = 1.0 - published_opacity(isotropic, level, degrees);
      const double marched = extinction_leak(medium, level, degrees);
      failure.table.add({double(level), double(degrees), plain, 1.0 - fraction, seen, predicted, marched});
      measured.points.push_back({double(level), seen, 0.0, "", 0.0});
      theory.points.push_back({double(level), predicted, 0.0, "", 0.0});
      extinction.points.push_back({double(level), marched, 0.0, "", 0.0});
      worst = std::max(worst, marched);
      off = std::max({off, std::abs(seen - predicted), std::abs(plain - 1.0 + fraction)});
    }
    for (Series* series : {&measured, &theory, &extinction}) chart.series.push_back(std::move(*series));
  }
  failure.charts.push_back(std::move(chart));
  failure.thresholds = {
      {"leak_extinction", worst, "", "most that a marched cone lets through a wall of one voxel, to 75 degrees"},
      {"leak_theory_gap", off, "", "most that the filtered opacity is off the two formulas"}};
  return failure;
}

Failure step_dependence() {
  Failure failure{
      "Step dependence",
      "Transmittance of a layer of one voxel and opacity 0.5 for steps of several lengths. Without correction n "
      "steps of length 1/n would transmit 0.5^n (dashed); extinction keeps 0.5.",
      {"stability_step",
       "Transmittance of a layer of one voxel of opacity 0.5",
       {{"step", "voxels"}, {"transmittance", ""}, {"uncorrected_theory", ""}},
       {}},
      {},
      {}};
  const Medium medium = make_medium(wall_pyramid(32, 0.5f, MipmapFilter::anisotropic));
  double worst = 0.0;
  for (const float step : {1.0f, 0.5f, 0.25f, 0.1f, 0.05f}) {
    double mean = 0.0;
    constexpr int offsets = 8;  // of the samples within the layer
    for (int i = 0; i < offsets; ++i) {
      const glm::vec3 start(4.0f + float(i) / offsets, 16.0f, 16.0f);
      const double left = 1.0 - double(march(medium, start, {1.0f, 0.0f, 0.0f}, 0.0f, {}, {.step = step}).opacity);
      mean += left / offsets;
      worst = std::max(worst, std::abs(left - 0.5));
    }
    failure.table.add({double(step), mean, std::pow(0.5, 1.0 / double(step))});
  }
  failure.charts.push_back(
      {"stability_step",
       "A layer of opacity 0.5, marched with steps of several lengths",
       {"step / voxels", true, {}, {}, {}},
       {"transmittance", false, 0.0, 0.6, {}},
       {curve(failure.table, "step", "transmittance", "extinction"),
        curve(failure.table, "step", "uncorrected_theory", "uncorrected (theory)", ChartStyle::dashes)}});
  failure.thresholds = {{"step_error", worst, "", "most that the transmittance is off 0.5, for any step and offset"}};
  return failure;
}

Failure cone_gaps() {
  Failure failure{
      "Gaps and overlaps of cones",
      "Radiance that falls with the cosine, L = cos, as each cone's own mean, cos (1 + cos a) / 2 at half-angle a, "
      "over "
      "the true irradiance 2 pi / 3; and the share of the hemisphere that is inside a cone, and inside two.",
      {"stability_cones",
       "Cone sets on radiance that falls with the cosine",
       {{"set", ""}, {"factor", ""}, {"theory", ""}, {"covered", ""}, {"overlap", ""}},
       {}},
      {},
      {}};
  struct Set {
    std::string name;
    std::vector<Cone> cones;
    double theory;  // of spec section 8; NaN: none given
  };
  std::vector<Set> sets = {{"villegas4", villegas4_cones(), 1.189}, {"villegas6", villegas6_cones(), 1.143}};
  for (const int count : {4, 6, 9, 16, 32, 64})
    sets.push_back({std::to_string(count), partition_hemisphere(count), std::nan("")});
  Series factors{"measured", ChartStyle::points, {}}, theory{"theory", ChartStyle::points, {}};
  Chart chart{"stability_cones",
              "Cone sets on L = cos",
              {"cones", false, {}, {}, {}},
              {"gathered / true irradiance", false, 0.95, 1.25, {}},
              {}};
  double worst = 0.0, off = 0.0;
  for (const Set& set : sets) {
    double sum = 0.0;
    for (const Cone& cone : set.cones) {
      const double cos_a = 1.0 / std::hypot(1.0, double(cone.tan_half_angle));
      sum += double(cone.weight) * double(cone.direction.z) * 0.5 * (1.0 + cos_a);
    }
    const double factor = sum / (2.0 * std::numbers::pi / 3.0);
    const Coverage covers = coverage(set.cones);
    failure.table.add({set.name, factor, set.theory, covers.covered, covers.overlap});
    const auto x = double(chart.x.categories.size());
    factors.points.push_back({x, factor, 0.0, fmt::format("{:.3f}", factor), 0.0});
    theory.points.push_back({x, set.theory, 0.0, "", 0.0});
    chart.x.categories.push_back(set.name);
    if (std::isnan(set.theory))
      worst = std::max(worst, std::abs(factor - 1.0));
    else
      off = std::max(off, std::abs(factor - set.theory));
  }
  chart.series = {factors, theory};
  failure.charts.push_back(std::move(chart));
  failure.thresholds = {{"cone_factor", worst, "", "most that a partition's factor is off 1"},
                        {"cone_factor_theory_gap", off, "", "how far the published sets are off 1.189 and 1.143"}};
  return failure;
}

namespace {

/// A floor 4 m wide at y = 0 (front up) and, beside it, a wall that glows with radiance 1 towards it.
Scene floor_and_wall(bool wall_glows, bool floor_glows) {
  Scene scene;
  const auto material = [&](const char* name, bool glows) {
    return add_material(scene,
                        glows ? emitter(name, glm::vec3(0.0f), glm::vec3(1.0f)) : lambertian(name, glm::vec3(0.0f)));
  };
  add_object(scene, "floor", plane(4.0f), material("floor", floor_glows));
  add_object(scene, "wall", quad({-1.0f, 0.0f, -2.0f}, {-1.0f, 2.0f, -2.0f}, {-1.0f, 2.0f, 2.0f}, {-1.0f, 0.0f, 2.0f}),
             material("wall", wall_glows));
  return scene;
}

/// Radiance over the hemisphere, irradiance / pi, from a rectangle of height b and half-width w that stands at distance
/// d on the receiver's plane: form factor of perpendicular rectangles to a point (Howell C-2 twice).
double perpendicular_factor(double d, double b, double w) {
  const double x = w / d, y = std::hypot(b, d);
  return (std::atan(x) - d / y * std::atan(w / y)) / std::numbers::pi;
}

}  // namespace

Failure contact_gap() {
  Failure failure{
      "Contact gap and self-lighting",
      "A cone starts off its surface by cone.start voxels. Too near, a glowing floor lights itself. The floor's light "
      "from "
      "a wall that glows is held against the form factor of perpendicular rectangles, one and four voxels from the "
      "contact: what a start further out would lose. (A march returns to the line from the surface itself as soon as "
      "that "
      "has risen as high as the start, so that little is lost.)",
      {"stability_contact",
       "Self-lighting, and relative error of light from a wall near its foot",
       {{"cones", ""}, {"start", "voxels"}, {"self_lighting", ""}, {"error_at_1", ""}, {"error_at_4", ""}},
       {}},
      {},
      {}};
  Chart chart{"stability_contact",
              "What the start of cones trades",
              {"cone.start / voxels", false, {}, {}, {}},
              {"self-lighting / radiance; relative error", false, {}, {}, {}},
              {}};
  GridOptions grid;
  grid.resolution = 64;
  const Scene dark_floor = floor_and_wall(true, false), dark_wall = floor_and_wall(false, true);
  const Medium wall_glows = glowing_medium(dark_floor, grid), floor_glows = glowing_medium(dark_wall, grid);
  const float voxel = wall_glows.texels.grid.voxel;
  double self_lighting = 0.0, gap = 0.0;
  for (const int cones : {6, 128}) {
    Series self{fmt::format("self-lighting, {} cones", cones), ChartStyle::line_points, {}};
    Series at_1{fmt::format("error 1 voxel from a wall, {} cones", cones), ChartStyle::line_points, {}};
    Series at_4{fmt::format("error 4 voxels from a wall, {} cones", cones), ChartStyle::line_points, {}};
    for (const float start : {0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f, 3.0f}) {
      ConeOptions options;
      options.start = start;
      const auto error_at = [&](float voxels) {
        const float d = voxels * voxel;
        const double truth = perpendicular_factor(double(d), 2.0, 2.0);
        return gathered(wall_glows, {d - 1.0f, 0.0f, 0.03f}, {0.0f, 1.0f, 0.0f}, cones, options) / truth - 1.0;
      };
      const double own = gathered(floor_glows, {0.5f, 0.0f, 0.03f}, {0.0f, 1.0f, 0.0f}, cones, options);
      const double error_1 = error_at(1.0f), error_4 = error_at(4.0f);
      failure.table.add({double(cones), double(start), own, error_1, error_4});
      self.points.push_back({double(start), own, 0.0, "", 0.0});
      at_1.points.push_back({double(start), error_1, 0.0, "", 0.0});
      at_4.points.push_back({double(start), error_4, 0.0, "", 0.0});
      if (start != ConeOptions{}.start) continue;
      self_lighting = std::max(self_lighting, own);
      gap = std::max(gap, std::abs(error_4));
    }
    for (Series* series : {&self, &at_1, &at_4}) chart.series.push_back(std::move(*series));
  }
  failure.charts.push_back(std::move(chart));
  failure.thresholds = {
      {"self_lighting", self_lighting, "", "of a glowing floor at the shipped start, over its radiance"},
      {"contact_error_4", gap, "", "relative error four voxels from a glowing wall, shipped start"}};
  return failure;
}

namespace {

/// Amplitudes of the harmonics of one voxel's period in `values`, which cover a whole number of periods, over the mean.
std::vector<double> harmonics(const std::vector<double>& values, size_t periods, size_t count) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double v : values) mean += v / n;
  std::vector<double> result;
  for (size_t k = 1; k <= count; ++k) {
    std::complex<double> sum = 0.0;
    for (size_t i = 0; i < values.size(); ++i)
      sum += (values[i] - mean) * std::polar(1.0, -2.0 * std::numbers::pi * double(k * periods) * double(i) / n);
    result.push_back(2.0 * std::abs(sum) / n / mean);
  }
  return result;
}

/// A floor 4 m wide and a glowing ball of radius 0.3 m over it, moved along x.
Scene floor_and_ball(float x) {
  Scene scene;
  add_object(scene, "floor", plane(4.0f), add_material(scene, lambertian("floor", glm::vec3(0.0f))));
  add_object(scene, "ball", moved(scaled(icosphere(3), 0.3f), {x, 0.8f, 0.0f}),
             add_material(scene, emitter("ball", glm::vec3(0.0f), glm::vec3(1.0f))));
  return scene;
}

Failure flicker_of(const std::string& name, const std::string& title, const std::string& text,
                   const std::vector<std::pair<int, std::vector<double>>>& runs, size_t periods) {
  Failure failure{title,
                  text,
                  {name,
                   "Light on the floor along the way, over its mean",
                   {{"cones", ""}, {"shift", "voxels"}, {"light", ""}},
                   {}},
                  {},
                  {}};
  Chart way{name, title, {"shift / voxels", false, {}, {}, {}}, {"light / mean", false, {}, {}, {}}, {}};
  Chart spectrum{name + "_spectrum",
                 title + ": spectrum",
                 {"frequency / (1 / voxel)", false, 0.5, 4.5, {}},
                 {"amplitude / mean", true, {}, {}, {}},
                 {}};
  for (const auto& [cones, values] : runs) {
    double mean = 0.0;
    for (const double v : values) mean += v / double(values.size());
    Series along{fmt::format("{} cones", cones), ChartStyle::line_points, {}}, lines = along;
    for (size_t i = 0; i < values.size(); ++i) {
      const double shift = double(i * periods) / double(values.size());
      failure.table.add({double(cones), shift, values[i] / mean});
      along.points.push_back({shift, values[i] / mean, 0.0, "", 0.0});
    }
    const std::vector<double> amplitudes = harmonics(values, periods, 4);
    for (size_t k = 0; k < amplitudes.size(); ++k) lines.points.push_back({double(k + 1), amplitudes[k], 0.0, "", 0.0});
    way.series.push_back(std::move(along));
    spectrum.series.push_back(std::move(lines));
    failure.thresholds.push_back({fmt::format("{}_{}_cones", name, cones), ripple(values), "",
                                  "peak to peak of the light less its straight trend, over its mean"});
  }
  failure.charts = {std::move(way), std::move(spectrum)};
  return failure;
}

constexpr size_t flicker_samples = 32, flicker_periods = 2;
constexpr int flicker_resolution = 48;

}  // namespace

Failure flicker() {
  std::vector<std::pair<int, std::vector<double>>> runs = {{6, {}}, {32, {}}};
  GridOptions grid;
  grid.resolution = flicker_resolution;
  grid.bounds = Bounds{{-2.1f, -0.2f, -2.1f}, {2.1f, 1.4f, 2.1f}};  // the grid stands still
  const float voxel = 4.2f / flicker_resolution;
  for (size_t i = 0; i < flicker_samples; ++i) {
    const float shift = voxel * float(i * flicker_periods) / float(flicker_samples);
    const Medium medium = glowing_medium(floor_and_ball(shift), grid);
    for (auto& [cones, values] : runs)
      values.push_back(gathered(medium, {0.1f, 0.0f, 0.07f}, {0.0f, 1.0f, 0.0f}, cones));
  }
  return flicker_of(
      "stability_flicker_object", "Flicker of a moving object's light",
      "A glowing ball moves by fractions of a voxel over a floor at rest; the light at one point of the floor. "
      "Truth changes smoothly along this way; what repeats with the voxel is the method's.",
      runs, flicker_periods);
}

Failure camera_flicker() {
  std::vector<std::pair<int, std::vector<double>>> runs = {{6, {}}, {32, {}}};
  GridOptions grid;
  grid.resolution = flicker_resolution;
  const Medium medium = glowing_medium(floor_and_ball(0.0f), grid);
  for (size_t i = 0; i < flicker_samples; ++i) {
    const float shift = medium.texels.grid.voxel * float(i * flicker_periods) / float(flicker_samples);
    for (auto& [cones, values] : runs)
      values.push_back(gathered(medium, {0.1f + shift, 0.0f, 0.07f}, {0.0f, 1.0f, 0.0f}, cones));
  }
  return flicker_of("stability_flicker_camera", "Light along a moving camera's way",
                    "Nothing moves but the point that is looked at, by fractions of a voxel along the floor.", runs,
                    flicker_periods);
}

}  // namespace voxref
