#include "error.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"

namespace voxref {

Scene red_green_wall() {
  Scene scene;
  const uint32_t white = add_material(scene, lambertian("white", glm::vec3(0.8f)));
  const uint32_t red = add_material(scene, lambertian("red", {0.8f, 0.0f, 0.0f}));
  const uint32_t green = add_material(scene, lambertian("green", {0.0f, 0.8f, 0.0f}));
  constexpr float x = 0.001f;  // half the gap between the sheets
  add_object(scene, "floor", plane(4.0f), white);
  add_object(scene, "red_sheet", quad({-x, 0, -2}, {-x, 0, 2}, {-x, 1.5f, 2}, {-x, 1.5f, -2}), red);
  add_object(scene, "green_sheet", quad({x, 0, 2}, {x, 0, -2}, {x, 1.5f, -2}, {x, 1.5f, 2}), green);
  scene.lights.push_back(point_light("left", {-1.0f, 1.0f, 0.0f}, glm::vec3(1.0f)));
  scene.lights.push_back(point_light("right", {1.0f, 1.0f, 0.0f}, glm::vec3(1.0f)));
  scene.cameras.push_back(camera("front", {0.0f, 2.2f, 5.0f}, {0.0f, 0.5f, 0.0f}, 45.0f, 1.5f));
  return scene;
}

Scene thin_wall(float thickness) {
  if (!(thickness > 0.0f && thickness <= 1.0f)) throw Error("thickness", "must be in (0, 1] metres");
  const float half = 0.5f * thickness;
  Scene scene;
  const uint32_t white = add_material(scene, lambertian("white", glm::vec3(0.7f)));
  add_object(scene, "lit_half", flipped(box({-1.0f, 0.0f, -0.5f}, {-half, 1.0f, 0.5f})), white);
  add_object(scene, "dark_half", flipped(box({half, 0.0f, -0.5f}, {1.0f, 1.0f, 0.5f})), white);
  // At least 0.2 m from every wall whatever the thickness.
  scene.lights.push_back(point_light("lamp", {-0.75f, 0.6f, 0.1f}, glm::vec3(1.0f)));
  scene.cameras.push_back(camera("lit", {-0.95f, 0.5f, 0.4f}, {-0.5f, 0.45f, -0.3f}, 75.0f, 1.0f));
  scene.cameras.push_back(camera("dark", {0.95f, 0.5f, 0.4f}, {0.5f, 0.45f, -0.3f}, 75.0f, 1.0f));
  return scene;
}

Scene light_box() {
  Scene scene;
  const uint32_t white = add_material(scene, lambertian("white", glm::vec3(0.8f)));
  add_object(scene, "room", flipped(rounded_box({1.0f, 0.75f, 1.0f}, 4.0f, 5)), white);
  scene.lights.push_back(point_light("low_lamp", {0.25f, -0.45f, -0.2f}, glm::vec3(1.0f)));
  scene.cameras.push_back(camera("inside", {-0.5f, 0.1f, 0.8f}, {0.2f, -0.15f, -0.6f}, 65.0f, 4.0f / 3.0f));
  return scene;
}

Scene plane_test() {
  Scene scene;
  const uint32_t ground = add_material(scene, lambertian("ground", glm::vec3(0.7f)));
  const uint32_t pillar = add_material(scene, lambertian("pillar", {0.7f, 0.25f, 0.2f}));
  add_object(scene, "plane", box({-2.0f, -0.1f, -2.0f}, {2.0f, 0.0f, 2.0f}), ground);
  // It stands 0.05 m deep in the slab: no two faces share a plane.
  add_object(scene, "tall_box", box({-1.7f, -0.05f, -1.7f}, {-1.5f, 2.5f, -1.5f}), pillar);
  scene.lights.push_back(sun("sun", {0.5f, -1.0f, 0.35f}, glm::vec3(3.0f)));
  scene.cameras.push_back(camera("front", {2.4f, 2.4f, 4.8f}, {-0.2f, 0.7f, -0.4f}, 45.0f, 4.0f / 3.0f));
  return scene;
}

}  // namespace voxref
