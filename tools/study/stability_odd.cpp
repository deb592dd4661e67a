// Scenes at the borders of what a scene is.
#include <cmath>
#include <optional>

#include "compare/statistics.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"
#include "study/stability.h"
#include "study/stability_setup.h"
#include "study/study_scenes.h"
#include "study/truth.h"

namespace voxref {

namespace {

constexpr int odd_voxels = 24, odd_width = 16, odd_bounces = 2;

TryTrace trace_odd(const Scene& scene) {
  Settings settings = small_settings(odd_voxels);
  settings.bounce.count = odd_bounces;
  return {scene, settings, odd_width};
}

/// Mean luminance of the same light, path traced.
Estimate true_mean(const Scene& scene) {
  View view;
  view.camera = scene.cameras.at(0);
  PathOptions options;
  options.spp = 256;
  options.max_depth = odd_bounces + 2;  // the last gather, and the direct light
  const PathResult result = trace_paths(scene, Caster(scene), sized(view, odd_width), options, {});
  return {double(luminance(result.mean)), double(luminance(result.mean_stderr))};
}

struct OddScene {
  std::string name, id;
  Scene scene;
  std::optional<double> exact{};  ///< the only mean that it may have, W/(sr m^2); none: the path tracer judges
};

Scene with_albedo(Scene scene, float albedo) {
  for (Material& m : scene.materials) m.base_color = {albedo, albedo, albedo, 1.0f};
  return scene;
}

Scene one_triangle() {
  Scene scene;
  add_triangle(scene, {0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f},
               add_material(scene, lambertian("grey", glm::vec3(0.5f))));
  scene.lights.push_back(point_light("lamp", {0.3f, 0.3f, 1.0f}, glm::vec3(1.0f)));
  scene.cameras.push_back(camera("front", {0.3f, 0.3f, 2.0f}, {0.3f, 0.3f, 0.0f}, 45.0f, 1.0f));
  return scene;
}

std::vector<OddScene> odd_scene_list() {
  const Scene box = cornell_box(CornellLight::point);
  const double usual = trace_odd(box).mean();
  std::vector<OddScene> list = {{"the Cornell box", "box", box}};
  const auto with_triangle = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Scene scene = box;
    add_triangle(scene, a, b, c, {0.0f, 1.0f, 0.0f}, 0);
    return scene;
  };
  // What has no area changes not a bit.
  list.push_back(
      {"a triangle that is a point", "", with_triangle(glm::vec3(0.2f), glm::vec3(0.2f), glm::vec3(0.2f)), usual});
  list.push_back(
      {"a triangle that is a line", "", with_triangle(glm::vec3(0.1f), glm::vec3(0.2f), glm::vec3(0.3f)), usual});
  // A needle 7e-9 m wide hides nothing, but the voxels that it runs through are opaque.
  list.push_back(
      {"a needle", "needle", with_triangle({0.1f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.10000001f})});
  list.push_back({"all black", "", with_albedo(box, 0.0f), 0.0});
  Scene unlit = box;
  unlit.lights.clear();
  list.push_back({"no light", "", std::move(unlit), 0.0});
  list.push_back({"albedo 1", "white", with_albedo(box, 1.0f)});
  // The box then lies in one voxel of 100 m: direct light, which needs no voxels, is all that is left of it.
  Scene huge = box;
  add_object(huge, "huge", moved(scaled(plane(1.0f), 2e3f), {0.0f, -0.01f, 0.0f}), 0);
  list.push_back({"a plane 4000 times as wide", "huge", std::move(huge)});
  list.push_back({"one triangle", "triangle", one_triangle()});
  return list;
}

}  // namespace

Failure odd_scenes() {
  Failure failure{"Odd scenes",
                  "Rendered with two bounces at 24 voxels, beside the path tracer with as many. Every value must be "
                  "finite; where no light is or nothing reflects it must be black, and triangles without area must not "
                  "change a bit. Of the rest, how far the mean is off is held to what it was.",
                  {"stability_odd",
                   "Scenes at the borders",
                   {{"scene", ""},
                    {"mean", "W/(sr m^2)"},
                    {"path_traced", "W/(sr m^2)"},
                    {"path_traced_stderr", "W/(sr m^2)"},
                    {"off", ""},
                    {"nonfinite", "pixels"},
                    {"outcome", ""}}}};
  double wrong = 0.0;
  for (const OddScene& odd : odd_scene_list()) {
    const TryTrace traced = trace_odd(odd.scene);
    const double mean = traced.mean();
    const Estimate truth = true_mean(odd.scene);
    const bool broken = std::isnan(mean) || (odd.exact && mean != *odd.exact);
    const Cell off = truth.mean > 0.0 ? Cell(mean / truth.mean - 1.0) : Cell{};
    failure.table.add({odd.name, mean, truth.mean, truth.error, off,
                       traced.result ? Cell(double(traced.result->image.nonfinite)) : Cell{},
                       !traced.result ? traced.outcome : std::string(broken ? "WRONG" : "as it should be")});
    wrong += broken ? 1.0 : 0.0;
    if (!odd.exact)
      failure.thresholds.push_back({"odd_" + odd.id, std::abs(mean / truth.mean - 1.0), "",
                                    odd.name + ": how far the mean is off the path tracer's, relative"});
  }
  failure.thresholds.push_back({"odd_scenes_wrong", wrong, "scenes", "that are not as they must be"});
  return failure;
}

}  // namespace voxref
