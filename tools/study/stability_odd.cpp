// Scenes at the borders of what a scene is.
#include <algorithm>
#include <cmath>

#include "image/image.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"
#include "study/stability.h"
#include "study/stability_setup.h"

namespace voxref {

namespace {

struct OddScene {
  std::string name;
  Scene scene;
  double low, high;  ///< that the mean may have, W/(sr m^2)
};

constexpr int odd_voxels = 24, odd_width = 16;

TryTrace trace_odd(const Scene& scene) {
  Settings settings = small_settings(odd_voxels);
  settings.bounce.count = 2;
  return {scene, settings, odd_width};
}

/// Mean luminance of the light that comes straight from the lamp: shadow rays, no voxels.
double direct_light(const Scene& scene) {
  const ConeTraceResult result = trace(scene, small_settings(odd_voxels), odd_width);
  const auto planes = result.image.image.layer("direct");
  double sum = 0.0;
  for (size_t i = 0; i < planes[0].size(); ++i) sum += double(luminance({planes[0][i], planes[1][i], planes[2][i]}));
  return sum / double(planes[0].size());
}

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
  const TryTrace usual = trace_odd(box);
  const double all = usual.result ? mean_luminance(*usual.result) : std::nan(""), direct = direct_light(box);
  std::vector<OddScene> list = {{"the Cornell box", box, 0.999 * all, 1.001 * all}};
  // What has no area changes nothing but, by a rounding, the grid.
  const auto with_triangle = [&](const std::string& name, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Scene scene = box;
    add_triangle(scene, a, b, c, {0.0f, 1.0f, 0.0f}, 0);
    list.push_back({name, std::move(scene), 0.99 * all, 1.01 * all});
  };
  with_triangle("a triangle that is a point", glm::vec3(0.2f), glm::vec3(0.2f), glm::vec3(0.2f));
  with_triangle("a triangle that is a line", glm::vec3(0.1f), glm::vec3(0.2f), glm::vec3(0.3f));
  // A needle 7e-9 m wide hides nothing, but the voxels that it runs through are opaque.
  Scene needle = box;
  add_triangle(needle, {0.1f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.10000001f}, {0.0f, 1.0f, 0.0f}, 0);
  list.push_back({"a needle", std::move(needle), 0.9 * all, 1.01 * all});
  list.push_back({"all black", with_albedo(box, 0.0f), 0.0, 0.0});
  Scene unlit = box;
  unlit.lights.clear();
  list.push_back({"no light", std::move(unlit), 0.0, 0.0});
  // Direct light grows with the albedo; two bounces and a gather cannot add more than three times what is there.
  const double white = direct_light(with_albedo(box, 1.0f));
  list.push_back({"albedo 1", with_albedo(box, 1.0f), white, 4.0 * white});
  // The box lies in one voxel of 100 m: direct light, which needs no voxels, is all that is left of it, to 1 %: rays
  // leave their surface by 4e-6 of the scene's size, 4 mm here.
  Scene huge = box;
  add_object(huge, "huge", moved(scaled(plane(1.0f), 2e3f), {0.0f, -0.01f, 0.0f}), 0);
  list.push_back({"a plane 4000 times as wide", std::move(huge), 0.99 * direct, 1.01 * direct});
  // A triangle half as wide as high fills some of the picture with at most albedo / pi x the irradiance under the lamp.
  list.push_back({"one triangle", one_triangle(), 0.1 * 0.5 / std::numbers::pi, 0.5 / std::numbers::pi});
  return list;
}

}  // namespace

Failure odd_scenes() {
  Failure failure{
      "Odd scenes",
      "Rendered with two bounces; every value must be finite, and the mean within the limits that are known: black "
      "where no light is or nothing reflects, unchanged by triangles without area, at least the direct light, which "
      "needs no voxels, and at most what bounces can add to it.",
      {"stability_odd",
       "Scenes at the borders",
       {{"scene", ""},
        {"mean", "W/(sr m^2)"},
        {"least", "W/(sr m^2)"},
        {"most", "W/(sr m^2)"},
        {"nonfinite", "pixels"},
        {"outcome", ""}}}};
  double wrong = 0.0;
  for (const OddScene& odd : odd_scene_list()) {
    const TryTrace traced = trace_odd(odd.scene);
    if (!traced.result) {
      failure.table.add({odd.name, Cell{}, odd.low, odd.high, Cell{}, traced.outcome});
      ++wrong;
      continue;
    }
    const double mean = mean_luminance(*traced.result);
    const size_t nonfinite = traced.result->image.nonfinite;
    const bool fine = nonfinite == 0 && mean >= odd.low && mean <= odd.high;
    failure.table.add(
        {odd.name, mean, odd.low, odd.high, double(nonfinite), std::string(fine ? "as it should be" : "WRONG")});
    if (!fine) ++wrong;
  }
  failure.thresholds = {{"odd_scenes_wrong", wrong, "scenes", "that are not as they should be"}};
  return failure;
}

}  // namespace voxref
