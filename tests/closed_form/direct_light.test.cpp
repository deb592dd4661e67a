// Light that is scattered once, at every pixel: a bias of 0.001 % is found, rounding hides less, and 0.09 % where nine
// lights are chosen among. Blind to what only more bounces show.
#include <cmath>
#include <numbers>

#include "catch.h"
#include "closed_form/expect.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

constexpr double pi = std::numbers::pi;
constexpr float albedo = 0.6f;

/// A floor alone: nothing is scattered twice.
Scene floor_scene() {
  Scene scene;
  add_floor(scene, 3.0f, add_material(scene, lambert(glm::vec3(albedo))));
  return scene;
}

/// From above, so that all pixels see the floor.
View floor_view() { return view_from({0.3f, 2.0f, 0.2f}, {0.0f, 0.0f, 0.0f}, 16, 16, 0.7f); }

}  // namespace

TEST_CASE("A point light over a plane gives I cos / d^2", "[closed_form]") {
  Scene scene = floor_scene();
  Light light;
  light.position = {0.4f, 1.5f, -0.3f};
  light.intensity = glm::vec3(7.0f);
  scene.lights.push_back(light);
  const View view = floor_view();
  expect_radiance(render(scene, view, 4), [&](int x, int y) {
    const glm::dvec3 d = glm::dvec3(light.position) - floor_point(view, x, y);
    const double cosine = d.y / glm::length(d);
    return albedo / pi * 7.0 * cosine / glm::dot(d, d);
  });
}

TEST_CASE("Each of many point lights gives its share", "[closed_form]") {
  // More than are looked at one by one: the light tree chooses.
  Scene scene = floor_scene();
  for (int i = 0; i < 9; ++i) {
    Light light;
    light.position = {0.5f * static_cast<float>(i % 3) - 0.5f, 1.0f + 0.1f * static_cast<float>(i),
                      0.5f * static_cast<float>(i / 3) - 0.5f};
    light.intensity = glm::vec3(1.0f + static_cast<float>(i));
    scene.lights.push_back(light);
  }
  const View view = floor_view();
  expect_radiance(render(scene, view, 1024), [&](int x, int y) {
    double sum = 0.0;
    for (const Light& light : scene.lights) {
      const glm::dvec3 d = glm::dvec3(light.position) - floor_point(view, x, y);
      sum += albedo / pi * light.intensity.g * d.y / std::pow(glm::length(d), 3.0);
    }
    return sum;
  });
}

TEST_CASE("A directional light on a tilted plane gives E cos", "[closed_form]") {
  for (const double tilt : {0.0, 0.4, 0.8}) {
    Scene scene;
    const glm::vec3 across(std::cos(tilt), std::sin(tilt), 0.0), along(0.0f, 0.0f, -1.0f);
    add_quad(scene, -5.0f * (across + along), 10.0f * across, 10.0f * along,
             add_material(scene, lambert(glm::vec3(albedo))));
    Light light;
    light.type = LightType::directional;
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = glm::vec3(2.0f);
    scene.lights.push_back(light);
    expect_radiance(render(scene, floor_view(), 2), [&](int, int) { return albedo / pi * 2.0 * std::cos(tilt); });
  }
}

TEST_CASE("A constant background over an unoccluded plane gives albedo times its radiance", "[closed_form]") {
  View view = floor_view();
  view.background = glm::vec3(2.5f);
  expect_radiance(render(floor_scene(), view, 16), [&](int, int) { return albedo * 2.5; });
}

TEST_CASE("A spot light fades as glTF says", "[closed_form]") {
  Scene scene = floor_scene();
  Light light;
  light.type = LightType::spot;
  light.position = {0.0f, 1.5f, 0.0f};
  light.direction = {0.0f, -1.0f, 0.0f};
  light.intensity = glm::vec3(4.0f);
  light.cos_inner = std::cos(0.2f);
  light.cos_outer = std::cos(0.5f);
  scene.lights.push_back(light);
  const View view = floor_view();
  expect_radiance(render(scene, view, 2), [&](int x, int y) {
    const glm::dvec3 d = glm::dvec3(light.position) - floor_point(view, x, y);
    const double cosine = d.y / glm::length(d);
    const double fade = (cosine - light.cos_outer) / (static_cast<double>(light.cos_inner) - light.cos_outer);
    const double factor = std::clamp(fade, 0.0, 1.0);
    // Left out close to the edge, where the factor is a difference of nearly equal cosines.
    return factor < 0.05 ? 0.0 : albedo / pi * 4.0 * factor * factor * cosine / glm::dot(d, d);
  });
}

}  // namespace voxref
