// Scenes at the borders of what a scene is.
#include <array>
#include <cmath>
#include <numbers>

#include "image/image.h"
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

/// Mean luminance of the light that comes straight from the lamp: shadow rays, no voxels.
double direct_light(const Scene& scene) {
  const TryTrace traced(scene, small_settings(odd_voxels), odd_width);
  if (std::isnan(traced.mean())) return traced.mean();
  const auto planes = traced.result->image.image.layer("direct");
  double sum = 0.0;
  for (size_t i = 0; i < planes[0].size(); ++i) sum += double(luminance({planes[0][i], planes[1][i], planes[2][i]}));
  return sum / double(planes[0].size());
}

/// The same light as trace_odd's, path traced.
PathResult trace_odd_paths(const Scene& scene) {
  View view;
  view.camera = scene.cameras.at(0);
  PathOptions options;
  options.spp = 256;
  options.max_depth = odd_bounces + 2;  // the last gather, and the direct light
  return trace_paths(scene, Caster(scene), sized(view, odd_width), options, {});
}

struct OddScene {
  std::string name, id;  ///< without an id the limits say all
  Scene scene;
  double least, most;  ///< that the mean may be, W/(sr m^2)
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
  const double usual = trace_odd(box).mean(), direct = direct_light(box);
  std::vector<OddScene> list = {{"the Cornell box", "box", box, usual, usual}};
  const auto add_with_triangle = [&](const std::string& name, const std::string& id, const std::array<glm::vec3, 3>& p,
                                     double least, double most) {
    Scene scene = box;
    add_triangle(scene, p[0], p[1], p[2], {0.0f, 1.0f, 0.0f}, 0);
    list.push_back({name, id, std::move(scene), least, most});
  };
  // What has no area changes not a bit.
  add_with_triangle("a triangle that is a point", "", {glm::vec3(0.2f), glm::vec3(0.2f), glm::vec3(0.2f)}, usual,
                    usual);
  add_with_triangle("a triangle that is a line", "", {glm::vec3(0.1f), glm::vec3(0.2f), glm::vec3(0.3f)}, usual, usual);
  // A needle 7e-9 m wide hides nothing, but the voxels that it runs through are opaque.
  add_with_triangle("a needle", "needle", {glm::vec3(0.1f), {0.5f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.10000001f}}, 0.9 * usual,
                    1.01 * usual);
  list.push_back({"all black", "", with_albedo(box, 0.0f), 0.0, 0.0});
  Scene unlit = box;
  unlit.lights.clear();
  list.push_back({"no light", "", std::move(unlit), 0.0, 0.0});
  // Direct light grows with the albedo; two bounces and a gather cannot add more than three times what is there.
  const double white = direct_light(with_albedo(box, 1.0f));
  list.push_back({"albedo 1", "white", with_albedo(box, 1.0f), white, 4.0 * white});
  // The box then lies in one voxel of 100 m: direct light, which needs no voxels, is all that is left of it, to 1 %:
  // rays leave their surface by 4e-6 of the scene's size, 4 mm here.
  Scene huge = box;
  add_object(huge, "huge", moved(scaled(plane(1.0f), 2e3f), {0.0f, -0.01f, 0.0f}), 0);
  list.push_back({"a plane 4000 times as wide", "huge", std::move(huge), 0.99 * direct, 1.01 * direct});
  // A triangle half as wide as high fills some of the picture with at most albedo / pi x the irradiance under the lamp.
  list.push_back({"one triangle", "triangle", one_triangle(), 0.1 * 0.5 / std::numbers::pi, 0.5 / std::numbers::pi});
  return list;
}

}  // namespace

Failure odd_scenes() {
  Failure failure{"Odd scenes",
                  "Rendered with two bounces at 24 voxels. Every value must be finite, and the mean within the limits "
                  "that are known: black where no light is or nothing reflects, not a bit changed by triangles without "
                  "area, at least the direct light, which needs no voxels, and at most what bounces can add to it; "
                  "where the box lies in one voxel the direct light alone. Beside it stands the path tracer with as "
                  "many bounces: how far the mean is off that, and to which side, is to stay what it was.",
                  {"stability_odd",
                   "Scenes at the borders",
                   {{"scene", ""},
                    {"mean", "W/(sr m^2)"},
                    {"least", "W/(sr m^2)"},
                    {"most", "W/(sr m^2)"},
                    {"path_traced", "W/(sr m^2)"},
                    {"path_traced_stderr", "W/(sr m^2)"},
                    {"off", ""},
                    {"nonfinite", "pixels"},
                    {"outcome", ""}}}};
  double wrong = 0.0;
  for (const OddScene& odd : odd_scene_list()) {
    const TryTrace traced = trace_odd(odd.scene);
    const double mean = traced.mean();
    const PathResult paths = trace_odd_paths(odd.scene);
    if (const std::string missing = missing_paths(paths.nonfinite, paths.first_nonfinite); !missing.empty())
      failure.warnings.push_back(odd.name + ": " + missing);
    const auto truth = double(luminance(paths.mean));
    const bool fine = mean >= odd.least && mean <= odd.most;  // NaN is not
    const Cell off = truth > 0.0 ? Cell(mean / truth - 1.0) : Cell{};
    failure.table.add({odd.name, mean, odd.least, odd.most, truth, double(luminance(paths.mean_stderr)), off,
                       traced.result ? Cell(double(traced.result->image.nonfinite)) : Cell{},
                       !traced.result ? traced.outcome : std::string(fine ? "as it should be" : "WRONG")});
    if (!fine) ++wrong;
    if (!odd.id.empty())
      failure.thresholds.push_back({"odd_" + odd.id, mean / truth - 1.0, "",
                                    odd.name + ": how far the mean is off the path tracer's, relative, with its sign",
                                    Worse::either});
  }
  failure.thresholds.push_back({"odd_scenes_wrong", wrong, "scenes", "that are not as they must be"});
  return failure;
}

}  // namespace voxref
