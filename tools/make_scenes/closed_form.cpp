#include <cmath>
#include <numbers>

#include "error.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"

namespace voxref {
namespace {

void require_albedo(float albedo) {
  if (!(albedo >= 0.0f && albedo < 1.0f)) throw Error("albedo", "must be in [0, 1)");
}

/// The plane that both direct-light scenes illuminate.
Scene lit_plane() {
  Scene scene;
  add_object(scene, "plane", plane(4.0f), add_material(scene, lambertian("grey", glm::vec3(0.5f))));
  return scene;
}

}  // namespace

Scene furnace(float albedo) {
  require_albedo(albedo);
  Scene scene;
  const uint32_t wall = add_material(scene, emitter("wall", glm::vec3(albedo), glm::vec3(1.0f)));
  add_object(scene, "cube", flipped(box(glm::vec3(-1.0f), glm::vec3(1.0f))), wall);
  scene.cameras.push_back(camera("inside", {0.2f, -0.1f, 0.3f}, {-1.0f, 0.3f, -0.7f}, 60.0f, 1.0f));
  return scene;
}

Scene sphere_furnace(float albedo, int subdivisions) {
  require_albedo(albedo);
  Mesh sphere = icosphere(subdivisions);
  sphere = flat_shaded(scaled(sphere, static_cast<float>(std::sqrt(4.0 * std::numbers::pi / area(sphere)))));
  Scene scene;
  add_object(scene, "sphere", flipped(sphere), add_material(scene, lambertian("wall", glm::vec3(albedo))));
  scene.lights.push_back(point_light("center", glm::vec3(0.0f), glm::vec3(1.0f)));
  scene.cameras.push_back(camera("inside", glm::vec3(0.0f), {0.3f, 0.2f, -1.0f}, 60.0f, 1.0f));
  return scene;
}

Scene point_light_over_plane() {
  Scene scene = lit_plane();
  scene.lights.push_back(point_light("lamp", {0.0f, 1.0f, 0.0f}, glm::vec3(1.0f)));
  scene.cameras.push_back(camera("above", {0.0f, 3.0f, 0.0f}, glm::vec3(0.0f), 60.0f, 1.0f, {0.0f, 0.0f, -1.0f}));
  return scene;
}

Scene rectangle_luminaire() {
  Scene scene = lit_plane();
  const Mesh downwards = moved(flipped(plane(1.0f)), {0.0f, 1.0f, 0.0f});
  add_object(scene, "luminaire", downwards,
             add_material(scene, emitter("luminaire", glm::vec3(0.0f), glm::vec3(1.0f))));
  scene.cameras.push_back(camera("side", {0.0f, 0.9f, 2.6f}, {0.0f, 0.1f, 0.0f}, 45.0f, 1.5f));
  return scene;
}

}  // namespace voxref
