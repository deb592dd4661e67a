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

constexpr std::array starts = {0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f, 3.0f};

/// By the start: self-lighting, and errors at 1 and 4 voxels.
struct ContactCurves {
  Table table{"stability_contact",
              "Self-lighting, and relative error of light from a wall near its foot",
              {{"cones", ""}, {"start", "voxels"}, {"self_lighting", ""}, {"error_at_1", ""}, {"error_at_4", ""}}};
  Chart own_light{"stability_contact_self",
                  "A glowing floor that lights itself",
                  {"start / voxels"},
                  {"self-lighting / radiance", false, 0.0}};
  Chart errors{"stability_contact", "Light of a wall near its foot", {"start / voxels"}, {"gathered / true light - 1"}};

  /// @param measure calls (start): Contact
  template <class Measure>
  void add_rows(const std::string& name, const Measure& measure) {
    Series own{name, ChartStyle::line_points}, close = own, further = own;
    close.title = name + ", 1 voxel from the wall";
    further.title = name + ", 4 voxels";
    for (const float start : starts) {
      const Contact c = measure(start);
      table.add({name, double(start), c.own, c.error_1, c.error_4});
      own.points.push_back(chart_point(double(start), c.own));
      close.points.push_back(chart_point(double(start), c.error_1));
      further.points.push_back(chart_point(double(start), c.error_4));
    }
    own_light.series.push_back(own);
    errors.series.push_back(close);
    errors.series.push_back(further);
  }
  /// Of the rows added last.
  Contact last_at(double start) const {
    return {value_at(own_light.series.back(), start), value_at(errors.series.rbegin()[1], start),
            value_at(errors.series.rbegin()[0], start)};
  }
};

/// Relative error of 512 cones at the shipped start, from the furthest place on.
std::vector<ChartPoint> errors_towards(const Medium& wall_glows) {
  const float voxel = wall_glows.texels.grid.voxel;
  std::vector<ChartPoint> errors;
  for (const float voxels : {24.0f, 16.0f, 12.0f, 8.0f, 6.0f, 4.0f, 3.0f, 2.0f, 1.0f}) {
    const double light = gathered(wall_glows, beside_wall(voxels, voxel), up, 512);
    errors.push_back(chart_point(double(voxels), std::abs(light / wall_light(voxels, voxel) - 1.0)));
  }
  return errors;
}

std::string contact_text(const Contact& six, const Contact& many, const Contact& published, double published_start) {
  return fmt::format(
      "A cone starts off its surface by a few voxels. Too near, a glowing floor lights itself. The floor's light from "
      "a wall that glows is held against the form factor of perpendicular rectangles, one and four voxels from the "
      "contact. A march returns to the line from the surface itself as soon as that has risen as high as the start, so "
      "that from 0.75 voxels on little depends on it. What is left is too much light, not too little: at the shipped "
      "start {:+.0f} % at one voxel and {:+.0f} % at four with 6 cones, whose texels at the wall's foot are nearly "
      "opaque where they hold a part of it; {:+.0f} and {:+.0f} % with 128.\n\nThe published cones start at {:g} "
      "voxels, take their first sample two voxels further and read opacity raw: {:+.0f} and {:+.0f} %, and a floor "
      "that glows with 1 lights itself with {:.2f}.",
      100.0 * six.error_1, 100.0 * six.error_4, 100.0 * many.error_1, 100.0 * many.error_4, published_start,
      100.0 * published.error_1, 100.0 * published.error_4, published.own);
}

}  // namespace

Failure contact_gap() {
  GridOptions grid;
  grid.resolution = resolution;
  const Scene floor_scene = corner(true, false), wall_scene = corner(false, true);
  const Medium floor_medium = glowing_medium(floor_scene, grid), wall_medium = glowing_medium(wall_scene, grid);
  const RawVolume floor_raw(glowing_pyramid(floor_scene, grid)), wall_raw(glowing_pyramid(wall_scene, grid));
  const auto shipped = double(ConeOptions{}.start), published_start = double(profile("villegas2016").render.cone.start);
  ContactCurves curves;
  double needed = 0.0;
  const auto add_cones = [&](int cones) {
    curves.add_rows(fmt::format("{} cones", cones), [&](float start) {
      ConeOptions options;
      options.start = start;
      return contact(floor_medium, wall_medium, wall_medium.texels.grid.voxel,
                     [&](const Medium& medium, const glm::vec3& p) { return gathered(medium, p, up, cones, options); });
    });
    const Series& own = curves.own_light.series.back();
    const std::vector<ChartPoint> from_far(own.points.rbegin(), own.points.rend());
    needed = worst_of({needed, breaks_at(from_far, weber_low)});
    return curves.last_at(shipped);
  };
  const Contact six = add_cones(6), many = add_cones(128);
  curves.add_rows("published six", [&](float start) { return published_contact(floor_raw, wall_raw, start); });
  const Contact published = curves.last_at(published_start);
  curves.errors.series.push_back(level_line(0.0, double(starts.front()), double(starts.back()), "theory"));
  curves.own_light.marks = {{needed, "lights itself below"}};
  const auto worst = [&](double Contact::*of) { return worst_of({std::abs(six.*of), std::abs(many.*of)}); };
  const std::vector<Threshold> thresholds = {
      {"self_lighting", worst_of({0.0, six.own, many.own}), "",
       "of a glowing floor at the shipped start, over its radiance"},
      {"self_lighting_start", needed, "voxels", "least start at which self-lighting is below 1 %"},
      {"contact_error_1", worst(&Contact::error_1), "", "relative error one voxel from a glowing wall, shipped start"},
      {"contact_error_4", worst(&Contact::error_4), "",
       "relative error four voxels from a glowing wall, shipped start"},
      {"contact_break", breaks_at(errors_towards(wall_medium), plan_error), "voxels",
       "from a glowing wall, below which 512 cones at the shipped start are off by 10 %; 1: they are not"},
      {"contact_published_self", published.own, "", "self-lighting of the published cones at their start, 2 voxels"},
      {"contact_published_1", std::abs(published.error_1), "",
       "relative error of theirs one voxel from a glowing wall"},
      {"contact_published_4", std::abs(published.error_4), "",
       "relative error of theirs four voxels from a glowing wall"}};
  return {"Contact gap and self-lighting",
          contact_text(six, many, published, published_start),
          std::move(curves.table),
          {curves.own_light, curves.errors},
          thresholds};
}

}  // namespace voxref
