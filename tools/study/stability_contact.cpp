// Where cones start.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "cone/raw_gather.h"
#include "make_scenes/shapes.h"
#include "study/curves.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

/// Radiance over the hemisphere, irradiance / pi, from a rectangle of height b and half-width w that stands at distance
/// d on the receiver's plane, opposite the middle of the rectangle's foot: Lambert's sum over its edges, of which the
/// foot and the upper one count.
double perpendicular_factor(double d, double b, double w) {
  const double x = w / d, y = std::hypot(b, d);
  return (std::atan(x) - d / y * std::atan(w / y)) / std::numbers::pi;
}

constexpr int resolution = 64;
const glm::vec3 up(0.0f, 1.0f, 0.0f);

/// A black or glowing floor and a wall beside it, whose foot is at x = -1.
Scene corner(bool floor_glows, bool wall_glows) {
  const Mesh standing = quad({-1.0f, 0.0f, -2.0f}, {-1.0f, 2.0f, -2.0f}, {-1.0f, 2.0f, 2.0f}, {-1.0f, 0.0f, 2.0f});
  return floor_and(standing, floor_glows, wall_glows);
}

/// A point of the floor at so many voxels from the wall.
glm::vec3 beside_wall(float voxels, float voxel) { return {voxels * voxel - 1.0f, 0.0f, 0.03f}; }
double wall_light(float voxels, float voxel) { return perpendicular_factor(double(voxels) * double(voxel), 2.0, 2.0); }
const glm::vec3 open_floor(0.5f, 0.0f, 0.03f);

/// What a floor gathers at a start.
struct Contact {
  double own = 0.0;                     ///< of its own light, over its radiance
  double error_1 = 0.0, error_4 = 0.0;  ///< of the light of a wall at 1 and 4 voxels, relative
};

/// @param light calls (medium or gatherer of the wall's or the floor's light, point): mean radiance
template <class Volume, class Light>
Contact contact(const Volume& floor_glows, const Volume& wall_glows, float voxel, const Light& light) {
  const auto error = [&](float voxels) {
    return light(wall_glows, beside_wall(voxels, voxel)) / wall_light(voxels, voxel) - 1.0;
  };
  return {light(floor_glows, open_floor), error(1.0f), error(4.0f)};
}

/// As the published shaders gather: six cones through raw opacity, first samples two voxels further than the start.
Contact published_contact(const RawVolume& floor_glows, const RawVolume& wall_glows, float start) {
  const auto light = [&](const RawVolume& volume, const glm::vec3& position) {
    GatherOptions options;
    options.cone = profile("villegas2016").render.cone;
    options.cone.start = start;
    options.box = {volume.texels.grid.min, volume.texels.grid.max()};
    const RawGatherer gatherer(volume, pixel_cones(options.cone.diffuse), options);
    return double(luminance(gatherer.diffuse({position, up, up, {}}).irradiance)) / std::numbers::pi;
  };
  return contact(floor_glows, wall_glows, wall_glows.texels.grid.voxel, light);
}

}  // namespace

Failure contact_gap() {
  Failure failure{
      "Contact gap and self-lighting",
      "",
      {"stability_contact",
       "Self-lighting, and relative error of light from a wall near its foot",
       {{"cones", ""}, {"start", "voxels"}, {"self_lighting", ""}, {"error_at_1", ""}, {"error_at_4", ""}}}};
  GridOptions grid;
  grid.resolution = resolution;
  const Scene floor_scene = corner(true, false), wall_scene = corner(false, true);
  const Medium floor_medium = glowing_medium(floor_scene, grid), wall_medium = glowing_medium(wall_scene, grid);
  const RawVolume floor_raw(glowing_pyramid(floor_scene, grid)), wall_raw(glowing_pyramid(wall_scene, grid));
  constexpr std::array starts = {0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f, 3.0f};
  const auto shipped = double(ConeOptions{}.start), published = double(profile("villegas2016").render.cone.start);
  Chart own_light{"stability_contact_self",
                  "A glowing floor that lights itself",
                  {"start / voxels"},
                  {"self-lighting / radiance", false, 0.0}};
  Chart errors{"stability_contact", "Light of a wall near its foot", {"start / voxels"}, {"gathered / true light - 1"}};
  const auto add_rows = [&](const std::string& name, const auto& measure) {
    Series own{name, ChartStyle::line_points}, near = own, far = own;
    near.title = name + ", 1 voxel from the wall";
    far.title = name + ", 4 voxels";
    for (const float start : starts) {
      const Contact c = measure(start);
      failure.table.add({name, double(start), c.own, c.error_1, c.error_4});
      own.points.push_back(chart_point(double(start), c.own));
      near.points.push_back(chart_point(double(start), c.error_1));
      far.points.push_back(chart_point(double(start), c.error_4));
    }
    own_light.series.push_back(own);
    errors.series.push_back(near);
    errors.series.push_back(far);
  };
  double self_lighting = 0.0, gap_1 = 0.0, gap_4 = 0.0, needed = 0.0;
  for (const int cones : {6, 128}) {
    add_rows(fmt::format("{} cones", cones), [&](float start) {
      ConeOptions options;
      options.start = start;
      return contact(floor_medium, wall_medium, wall_medium.texels.grid.voxel,
                     [&](const Medium& medium, const glm::vec3& p) { return gathered(medium, p, up, cones, options); });
    });
    const Series& own = own_light.series.back();
    const std::vector<ChartPoint> from_far(own.points.rbegin(), own.points.rend());
    needed = worst_of({needed, breaks_at(from_far, weber_low)});
    self_lighting = worst_of({self_lighting, value_at(own, shipped)});
    gap_1 = worst_of({gap_1, std::abs(value_at(errors.series.rbegin()[1], shipped))});
    gap_4 = worst_of({gap_4, std::abs(value_at(errors.series.rbegin()[0], shipped))});
  }
  add_rows("published six", [&](float start) { return published_contact(floor_raw, wall_raw, start); });
  const double published_own = value_at(own_light.series.back(), published),
               published_1 = value_at(errors.series.rbegin()[1], published),
               published_4 = value_at(errors.series.rbegin()[0], published);
  errors.series.push_back(level_line(0.0, double(starts.front()), double(starts.back()), "theory"));
  own_light.marks = {{needed, "lights itself below"}};
  failure.charts = {own_light, errors};
  std::vector<ChartPoint> from_far;
  for (const float voxels : {24.0f, 16.0f, 12.0f, 8.0f, 6.0f, 4.0f, 3.0f, 2.0f, 1.0f}) {
    const double light = gathered(wall_medium, beside_wall(voxels, wall_medium.texels.grid.voxel), up, 512);
    from_far.push_back(
        chart_point(double(voxels), std::abs(light / wall_light(voxels, wall_medium.texels.grid.voxel) - 1.0)));
  }
  failure.text = fmt::format(
      "A cone starts off its surface by a few voxels. Too near, a glowing floor lights itself. The floor's light from "
      "a wall that glows is held against the form factor of perpendicular rectangles, one and four voxels from the "
      "contact. A march returns to the line from the surface itself as soon as that has risen as high as the start, so "
      "that from 0.75 voxels on little depends on it. What is left is too much light, not too little: at the shipped "
      "start {:+.0f} % at one voxel and {:+.0f} % at four with 6 cones, whose texels at the wall's foot are nearly "
      "opaque where they hold a part of it; {:+.0f} and {:+.0f} % with 128.\n\nThe published cones start at {:g} "
      "voxels, take their first sample two voxels further and read opacity raw: {:+.0f} and {:+.0f} %, and a floor "
      "that glows with 1 lights itself with {:.2f}.",
      100.0 * value_at(errors.series[0], shipped), 100.0 * value_at(errors.series[1], shipped),
      100.0 * value_at(errors.series[2], shipped), 100.0 * value_at(errors.series[3], shipped), published,
      100.0 * published_1, 100.0 * published_4, published_own);
  failure.thresholds = {
      {"self_lighting", self_lighting, "", "of a glowing floor at the shipped start, over its radiance"},
      {"self_lighting_start", needed, "voxels", "least start at which self-lighting is below 1 %"},
      {"contact_error_1", gap_1, "", "relative error one voxel from a glowing wall, shipped start"},
      {"contact_error_4", gap_4, "", "relative error four voxels from a glowing wall, shipped start"},
      {"contact_break", breaks_at(from_far, plan_error), "voxels",
       "from a glowing wall, below which 512 cones at the shipped start are off by 10 %; 1: they are not"},
      {"contact_published_self", published_own, "", "self-lighting of the published cones at their start, 2 voxels"},
      {"contact_published_1", std::abs(published_1), "", "relative error of theirs one voxel from a glowing wall"},
      {"contact_published_4", std::abs(published_4), "", "relative error of theirs four voxels from a glowing wall"}};
  return failure;
}

}  // namespace voxref
