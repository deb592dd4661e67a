#include "scene/camera.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "catch.h"
#include "error.h"
#include "scene/scene.h"

using namespace voxref;

namespace {
// One rounding of a unit vector's component in float32 is 6e-8; a handful add up.
constexpr float rounding = 1e-6f;
}  // namespace

TEST_CASE("a perspective camera's rays follow the glTF convention", "[camera]") {
  View view;
  view.width = 200;
  view.height = 100;
  view.camera.yfov = glm::radians(90.0f);
  const RayGenerator rays(view);
  SECTION("the image's centre looks along -Z") {
    const Ray ray = rays({100.0f, 50.0f});
    CHECK(glm::distance(ray.direction, glm::vec3(0.0f, 0.0f, -1.0f)) < rounding);
  }
  SECTION("the upper edge is half the field of view up, the right edge aspect times as far to the right") {
    const glm::vec3 up = rays({100.0f, 0.0f}).direction;
    CHECK(glm::distance(up, glm::normalize(glm::vec3(0.0f, 1.0f, -1.0f))) < rounding);
    const glm::vec3 right = rays({200.0f, 50.0f}).direction;
    CHECK(glm::distance(right, glm::normalize(glm::vec3(2.0f, 0.0f, -1.0f))) < rounding);
  }
}

TEST_CASE("an orthographic camera's rays are parallel and span twice its magnification", "[camera]") {
  View view;
  view.width = view.height = 10;
  view.camera.orthographic = true;
  view.camera.ymag = 3.0f;
  const RayGenerator rays(view);
  const Ray corner = rays({0.0f, 0.0f});
  CHECK(glm::distance(corner.origin, glm::vec3(-3.0f, 3.0f, 0.0f)) < rounding);
  CHECK(glm::distance(corner.direction, glm::vec3(0.0f, 0.0f, -1.0f)) < rounding);
}

TEST_CASE("look_at puts the target in the image's centre and refuses what has no direction", "[camera]") {
  View view;
  view.camera = look_at({1.0f, 2.0f, 3.0f}, {4.0f, -2.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 1.0f);
  const RayGenerator rays(view);
  const glm::vec3 expected = glm::normalize(glm::vec3(3.0f, -4.0f, -3.0f));
  CHECK(glm::distance(rays({256.0f, 256.0f}).direction, expected) < rounding);
  CHECK(rays({256.0f, 0.0f}).direction.y > expected.y);
  CHECK_THROWS_AS(look_at({1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 1.0f), Error);
  CHECK_THROWS_AS(look_at({0, 0, 0}, {0, 5, 0}, {0, 1, 0}, 1.0f), Error);
  CHECK_THROWS_AS(look_at({0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 1.0f), Error);
}

TEST_CASE("the framing camera sees every corner of the scene's box", "[camera]") {
  Scene scene;
  scene.positions = {{-3.0f, 0.0f, 1.0f}, {5.0f, 1.0f, 1.0f}, {0.0f, 2.0f, -9.0f}};
  scene.normals.assign(3, {0.0f, 1.0f, 0.0f});
  scene.triangles = {{0, 1, 2}};
  View view;
  view.camera = framing_camera(scene);
  const RayGenerator rays(view);
  const Bounds bounds = scene.bounds();
  const float edge = std::cos(0.5f * view.camera.yfov);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                          corner & 4 ? bounds.max.z : bounds.min.z);
    CHECK(glm::dot(glm::normalize(point - rays.eye()), rays.forward()) > edge);
  }
}
