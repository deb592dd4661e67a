// Failures of whole scenes, through the whole pipeline.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "error.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/catalog.h"
#include "make_scenes/shapes.h"
#include "pipeline.h"
#include "study/deviation.h"
#include "study/stability_curves.h"
#include "study/study_scenes.h"

namespace voxref {

namespace {

Settings small_settings(int resolution) {
  Settings settings;
  settings.grid.resolution = resolution;
  settings.bounce.count = 0;
  return settings;
}

ConeTraceResult trace(const Scene& scene, const Settings& settings, int width, size_t camera = 0) {
  View view;
  view.camera = scene.cameras.at(camera);
  view = sized(view, width);
  return cone_trace(scene, Caster(scene), view, settings);
}

double mean_luminance(const ConeTraceResult& result) { return double(luminance(result.mean)); }

/// Every point of the scene, lights and cameras too, turned about +Z and then moved.
Scene placed(Scene scene, float degrees, const glm::vec3& offset) {
  const float c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
  const auto turn = [&](const glm::vec3& v) { return glm::vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z); };
  for (glm::vec3& p : scene.positions) p = turn(p) + offset;
  for (glm::vec3& n : scene.normals) n = turn(n);
  for (Light& light : scene.lights) {
    light.position = turn(light.position) + offset;
    light.direction = turn(light.direction);
  }
  for (Camera& camera : scene.cameras)
    for (int column = 0; column < 4; ++column) {
      const glm::vec3 moved =
          turn(glm::vec3(camera.world_from_camera[column])) + (column == 3 ? offset : glm::vec3(0.0f));
      camera.world_from_camera[column] = glm::vec4(moved, camera.world_from_camera[column].w);
    }
  return scene;
}

}  // namespace

Failure leak_by_thickness() {
  Failure failure{"Leaks by the thickness of a wall",
                  "A closed room cut in two by a wall, a lamp in one half: the other half is black. Shown is the mean "
                  "radiance of the dark half over that of the lit one, direct light at the voxels alone.",
                  {"stability_leak_thickness",
                   "Dark half over lit half, by the thickness of the wall between them",
                   {{"thickness", "voxels"}, {"leak", ""}},
                   {}},
                  {},
                  {}};
  constexpr int resolution = 48, width = 24;
  const float voxel = 2.0f / (resolution - 3);
  double worst = 0.0, thick = 0.0;
  for (const float voxels : {0.25f, 0.5f, 0.75f, 1.0f, 1.5f, 2.0f, 2.5f, 3.0f, 4.0f}) {
    const Scene scene = thin_wall(voxels * voxel);
    const Settings settings = small_settings(resolution);
    const double lit = mean_luminance(trace(scene, settings, width, 0));
    const double leak = mean_luminance(trace(scene, settings, width, 1)) / lit;
    failure.table.add({double(voxels), leak});
    worst = std::max(worst, leak);
    if (voxels == 4.0f) thick = leak;
  }
  failure.charts.push_back({"stability_leak_thickness",
                            "Light behind a wall",
                            {"thickness / voxels", false, 0.0, {}, {}},
                            {"dark half / lit half", false, 0.0, {}, {}},
                            {curve(failure.table, "thickness", "leak", "6 cones, 48 voxels")}});
  failure.thresholds = {{"leak_thin_wall", worst, "", "most that a wall lets through, from a quarter of a voxel on"},
                        {"leak_thick_wall", thick, "", "what four voxels let through"}};
  return failure;
}

Failure rotation() {
  Failure failure{
      "Rotation against the grid",
      "A closed cube that glows with radiance 1 shows 1 everywhere. Turned about one axis, its walls cross the "
      "grid at an angle.",
      {"stability_rotation",
       "What a closed glowing cube shows of its radiance",
       {{"angle", "degrees"}, {"cones_6", ""}, {"cones_32", ""}},
       {}},
      {},
      {}};
  double lost = 0.0;
  for (const float degrees : {0.0f, 5.0f, 15.0f, 22.5f, 30.0f, 45.0f}) {
    GridOptions grid;
    grid.resolution = 48;
    const Medium medium = glowing_medium(placed(furnace(0.0f), degrees, glm::vec3(0.0f)), grid);
    const auto shown = [&](int cones) {
      double sum = 0.0;
      const float c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
      constexpr int points = 8;
      for (int i = 0; i < points; ++i) {  // on the floor, from the middle to near the edge
        const float x = 0.85f * float(i) / (points - 1);
        sum += gathered(medium, {c * x + s, s * x - c, 0.37f * x}, {-s, c, 0.0f}, cones) / points;
      }
      return sum;
    };
    const double six = shown(6), many = shown(32);
    failure.table.add({double(degrees), six, many});
    lost = std::max({lost, std::abs(1.0 - six), std::abs(1.0 - many)});
  }
  failure.charts.push_back(
      {"stability_rotation",
       "A closed glowing cube, turned against the grid",
       {"angle / degrees", false, {}, {}, {}},
       {"shown / true radiance", false, 0.9, 1.05, {}},
       {curve(failure.table, "angle", "cones_6", "6 cones"), curve(failure.table, "angle", "cones_32", "32 cones")}});
  failure.thresholds = {{"rotation_error", lost, "", "most that a glowing room's radiance is off, at any angle"}};
  return failure;
}

Failure scale() {
  Failure failure{
      "Scale",
      "The Cornell box with every length times a factor; lights keep the irradiance. The image must not change.",
      {"stability_scale", "Mean radiance over that at scale 1", {{"scale", ""}, {"ratio", ""}}, {}},
      {},
      {}};
  const Scene box = cornell_box(CornellLight::point);
  const double usual = mean_luminance(trace(box, small_settings(32), 16));
  double off = 0.0;
  for (const float factor : {1e-3f, 1e-2f, 1e-1f, 1.0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f}) {
    const double ratio = mean_luminance(trace(scaled(box, factor), small_settings(32), 16)) / usual;
    failure.table.add({double(factor), ratio});
    off = std::max(off, std::abs(ratio - 1.0));
  }
  failure.charts.push_back({"stability_scale",
                            "The Cornell box in other sizes",
                            {"scale", true, {}, {}, {}},
                            {"mean radiance / that at scale 1", false, 0.98, 1.02, {}},
                            {curve(failure.table, "scale", "ratio", "measured")}});
  failure.thresholds = {{"scale_error", off, "", "most that the mean changes from 1e-3 to 1e6"}};
  return failure;
}

Failure distance() {
  Failure failure{
      "Distance from the origin",
      "The Cornell box, half a metre wide, moved away from the origin by 1 to 1e6 m. Coordinates in float32 are "
      "then known to 6e-8 of the distance; where voxels cannot be told apart the grid refuses, and the row says "
      "so.",
      {"stability_distance",
       "Mean radiance over that at the origin",
       {{"distance", "m"}, {"rounding", "voxels"}, {"ratio", ""}, {"outcome", ""}},
       {}},
      {},
      {}};
  const Scene box = cornell_box(CornellLight::point);
  const double usual = mean_luminance(trace(box, small_settings(32), 16));
  double reach = 0.0;
  bool silent = false;
  for (const float away : {1.0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f}) {
    const double rounding = double(away) * 0x1p-24 / (double(box.bounds().extent().x) / 29.0);
    try {
      const double ratio =
          mean_luminance(trace(placed(box, 0.0f, glm::vec3(away, 0.0f, 0.0f)), small_settings(32), 16)) / usual;
      failure.table.add({double(away), rounding, ratio, "rendered"});
      constexpr double tolerable = 0.05;
      const bool right = std::abs(ratio - 1.0) <= tolerable;
      if (right) reach = std::max(reach, double(away));
      silent = silent || !right;
    } catch (const Error& error) {
      failure.table.add({double(away), rounding, Cell{}, std::string("refused: ") + error.what()});
    }
  }
  failure.charts.push_back({"stability_distance",
                            "The Cornell box far from the origin",
                            {"distance / m", true, {}, {}, {}},
                            {"mean radiance / that at the origin", false, 0.0, 1.5, {}},
                            {curve(failure.table, "distance", "ratio", "measured")}});
  failure.thresholds = {{"distance_lost_decades", 6.0 - std::log10(std::max(reach, 1.0)), "decades",
                         "before 1e6 m at which the mean is off 5 % or the scene is refused"},
                        {"distance_silent", silent ? 1.0 : 0.0, "", "1: a wrong image came without an error"}};
  return failure;
}

Failure clamping() {
  Failure failure{
      "Clamping in bytes",
      "The Cornell box under a lamp of growing power, in unorm8 against float32. Bytes hold radiance to 1; beyond, "
      "light is lost, and far below, rounding takes over.",
      {"stability_clamping",
       "Mean indirect light in unorm8 over that in float32, and the voxels' peak",
       {{"light_scale", ""}, {"peak", "W/(sr m^2)"}, {"ratio", ""}},
       {}},
      {},
      {}};
  const Scene box = cornell_box(CornellLight::point);
  double below = 0.0;
  for (const float power : {1e-3f, 1e-2f, 0.03f, 0.1f, 0.3f, 1.0f, 3.0f, 10.0f, 100.0f}) {
    Scene scene = box;
    for (Light& light : scene.lights) light.intensity *= power;
    const Settings settings = small_settings(32);
    const Caster caster(scene);
    const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), {});
    float peak = 0.0f;
    for (const glm::vec3& r : shade(scene, &caster, surfaces, {}, {}).radiance) peak = std::max({peak, r.r, r.g, r.b});
    const auto indirect = [&](Storage storage) {
      Settings stored = settings;
      stored.storage = storage;
      return measured_cone(trace(scene, stored, 16).image.image, true).mean();
    };
    const double ratio = indirect(Storage::unorm8) / indirect(Storage::float32);
    failure.table.add({double(power), double(peak), ratio});
    constexpr float dim = 0.3f;  // 77 levels of 255: rounding is still small
    if (peak <= 1.0f && peak > dim) below = std::max(below, std::abs(ratio - 1.0));
  }
  Series limit{"radiance 1", ChartStyle::dashes, {{1.0, 0.0, 0.0, "", 0.0}, {1.0, 1.2, 0.0, "", 0.0}}};
  failure.charts.push_back({"stability_clamping",
                            "Light that bytes lose",
                            {"peak radiance of the voxels / (W/(sr m^2))", true, {}, {}, {}},
                            {"indirect light, unorm8 / float32", false, 0.0, 1.2, {}},
                            {curve(failure.table, "peak", "ratio", "measured"), limit}});
  failure.thresholds = {
      {"clamping_below_1", below, "", "most that bytes change the light while the peak is from 0.3 to 1"}};
  return failure;
}

Failure feedback_gain() {
  Failure failure{
      "Feedback gain of the bounces",
      "A closed cube that glows with 1 and reflects the share r: each bounce adds r times the one before, in all "
      "1 / (1 - r). A gain at or above 1 is refused.",
      {"stability_gain",
       "Loop gain, and total light over 1 / (1 - r)",
       {{"albedo", ""}, {"gain", ""}, {"total_ratio", ""}, {"outcome", ""}},
       {}},
      {},
      {}};
  double off = 0.0, above = 0.0;
  for (const float albedo : {0.2f, 0.4f, 0.6f, 0.8f, 0.9f, 0.95f}) {
    const Scene room = furnace(albedo);
    Settings settings = small_settings(16);
    settings.bounce.count.reset();
    const ConeTraceResult result = trace(room, settings, 8);
    const double ratio = mean_luminance(result) * (1.0 - double(albedo));
    failure.table.add({double(albedo), result.gain, ratio, "rendered"});
    off = std::max(off, std::abs(result.gain - double(albedo)));
    above = std::max(above, result.gain - double(albedo));
  }
  Scene mirror = furnace(0.5f);
  for (Material& m : mirror.materials) m.base_color = glm::vec4(1.0f);
  std::string outcome = "rendered";
  double gain = std::nan("");
  try {
    Settings settings = small_settings(16);
    settings.bounce.count = 20;  // endless light has no automatic end
    gain = trace(mirror, settings, 8).gain;
  } catch (const Error& error) {
    outcome = error.what();
  }
  failure.table.add({1.0, gain, Cell{}, outcome});
  failure.charts.push_back({"stability_gain",
                            "Loop gain of the bounces in a closed room",
                            {"albedo", false, 0.0, 1.05, {}},
                            {"gain", false, 0.0, 1.05, {}},
                            {curve(failure.table, "albedo", "gain", "measured"),
                             curve(failure.table, "albedo", "albedo", "theory: the albedo", ChartStyle::dashes)}});
  failure.thresholds = {{"gain_error", off, "", "most that the gain is off the albedo, to albedo 0.95"},
                        {"gain_excess", above, "", "most that it is above the albedo"}};
  return failure;
}

namespace {

struct OddScene {
  std::string name;
  Scene scene;
  double low, high;  // that the mean may have
};

std::vector<OddScene> odd_scene_list() {
  const Scene box = cornell_box(CornellLight::point);
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::vector<OddScene> list = {{"the Cornell box", box, 1e-3, inf}};
  const auto with_triangle = [&](const std::string& name, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Scene scene = box;
    Mesh mesh;
    for (const glm::vec3& p : {a, b, c}) add_vertex(mesh, p, {0.0f, 1.0f, 0.0f});
    mesh.triangles.emplace_back(0u, 1u, 2u);
    add_object(scene, "odd", mesh, 0);
    list.push_back({name, std::move(scene), 1e-3, inf});
  };
  with_triangle("a triangle that is a point", glm::vec3(0.2f), glm::vec3(0.2f), glm::vec3(0.2f));
  with_triangle("a triangle that is a line", glm::vec3(0.1f), glm::vec3(0.2f), glm::vec3(0.3f));
  with_triangle("a needle", {0.1f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.10000001f});
  Scene black = box;
  for (Material& m : black.materials) m.base_color = {0.0f, 0.0f, 0.0f, 1.0f};
  list.push_back({"all black", std::move(black), 0.0, 0.0});
  Scene unlit = box;
  unlit.lights.clear();
  list.push_back({"no light", std::move(unlit), 0.0, 0.0});
  Scene white = box;
  for (Material& m : white.materials) m.base_color = glm::vec4(1.0f);
  list.push_back({"albedo 1", std::move(white), 1e-3, inf});
  Scene huge = box;
  Mesh floor = scaled(plane(1.0f), 1e3f);
  add_object(huge, "huge", moved(floor, {0.0f, -0.01f, 0.0f}), 0);
  list.push_back({"a plane 2000 times as wide", std::move(huge), 0.0, inf});
  Scene one;
  Mesh triangle;
  for (const glm::vec3& p : {glm::vec3(0.0f), glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)})
    add_vertex(triangle, p, {0.0f, 0.0f, 1.0f});
  triangle.triangles.emplace_back(0u, 1u, 2u);
  add_object(one, "one", triangle, add_material(one, lambertian("grey", glm::vec3(0.5f))));
  one.lights.push_back(point_light("lamp", {0.3f, 0.3f, 1.0f}, glm::vec3(1.0f)));
  one.cameras.push_back(camera("front", {0.3f, 0.3f, 2.0f}, {0.3f, 0.3f, 0.0f}, 45.0f, 1.0f));
  list.push_back({"one triangle", std::move(one), 1e-3, inf});
  return list;
}

}  // namespace

Failure odd_scenes() {
  Failure failure{
      "Odd scenes",
      "Rendered with two bounces; every value must be finite, and black where no light is or nothing reflects.",
      {"stability_odd",
       "Scenes at the borders",
       {{"scene", ""}, {"mean", "W/(sr m^2)"}, {"nonfinite", "pixels"}, {"outcome", ""}},
       {}},
      {},
      {}};
  double wrong = 0.0;
  for (const OddScene& odd : odd_scene_list()) {
    Settings settings = small_settings(24);
    settings.bounce.count = 2;
    const ConeTraceResult result = trace(odd.scene, settings, 16);
    const double mean = mean_luminance(result);
    const bool fine = result.image.nonfinite == 0 && mean >= odd.low && mean <= odd.high;
    failure.table.add({odd.name, mean, double(result.image.nonfinite), fine ? "as it should be" : "WRONG"});
    if (!fine) ++wrong;
  }
  failure.thresholds = {{"odd_scenes_wrong", wrong, "scenes", "that are not as they should be"}};
  return failure;
}

std::vector<Failure (*)()> failures() {
  return {leak_by_level, leak_by_thickness, contact_gap, step_dependence, flicker,   camera_flicker, rotation,
          scale,         distance,          clamping,    feedback_gain,   cone_gaps, odd_scenes};
}

StudyResult run_stability(const StudyRequest& request) {
  StudyResult result{"stability", "where the method breaks", {}, {}};
  Table thresholds{"stability_thresholds",
                   "The larger, the worse",
                   {{"threshold", ""}, {"value", ""}, {"unit", ""}, {"meaning", ""}},
                   {}};
  for (const auto& measure : failures()) {
    request.progress.check();
    result.sections.push_back(timed_section("", [&](Section& section) {
      Failure failure = measure();
      section.title = failure.title;
      section.text = failure.text;
      for (const Threshold& t : failure.thresholds) thresholds.add({t.name, t.value, t.unit, t.meaning});
      section.charts = std::move(failure.charts);
      section.tables.push_back(std::move(failure.table));
    }));
  }
  result.sections.push_back(timed_section("Thresholds", [&](Section& section) {
    section.text = "tests/stability holds each of them below a limit.";
    section.tables.push_back(std::move(thresholds));
  }));
  return result;
}

}  // namespace voxref
