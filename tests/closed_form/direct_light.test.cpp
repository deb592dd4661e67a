#include <array>
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

/// Irradiance of a polygon of radiance 1 on a plane of the given normal, counter-clockwise seen from the receiver;
/// Lambert 1760, E = 1/2 sum over edges of the angle that the edge subtends times the normal of its plane.
template <size_t Count>
double polygon_irradiance(const std::array<glm::dvec3, Count>& corners, const glm::dvec3& point,
                          const glm::dvec3& normal) {
  double sum = 0.0;
  for (size_t i = 0; i < Count; ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - point), b = glm::normalize(corners[(i + 1) % Count] - point);
    sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), normal);
  }
  return 0.5 * std::abs(sum);
}

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
  // More than are looked at one by one: the choice by power.
  Scene scene = floor_scene();
  for (int i = 0; i < 9; ++i) {
    Light light;
    light.position = {0.5f * static_cast<float>(i % 3) - 0.5f, 1.0f + 0.1f * static_cast<float>(i),
                      0.5f * static_cast<float>(i / 3) - 0.5f};
    light.intensity = glm::vec3(1.0f + static_cast<float>(i));
    scene.lights.push_back(light);
  }
  const View view = floor_view();
  expect_radiance(render(scene, view, 256), [&](int x, int y) {
    double sum = 0.0;
    for (const Light& light : scene.lights) {
      const glm::dvec3 d = glm::dvec3(light.position) - floor_point(view, x, y);
      sum += albedo / pi * light.intensity.g * d.y / std::pow(glm::length(d), 3.0);
    }
    return sum;
  });
}

TEST_CASE("A directional light on a tilted plane gives E cos", "[closed_form]") {
  for (const double tilt : {0.0, 0.6, 1.2}) {
    Scene scene = floor_scene();
    Light light;
    light.type = LightType::directional;
    light.direction = glm::vec3(std::sin(tilt), -std::cos(tilt), 0.0);
    light.intensity = glm::vec3(2.0f);
    scene.lights.push_back(light);
    expect_radiance(render(scene, floor_view(), 2), [&](int, int) { return albedo / pi * 2.0 * std::cos(tilt); });
  }
}

TEST_CASE("A rectangle luminaire over a plane gives Lambert's polygon formula", "[closed_form]") {
  Scene scene = floor_scene();
  add_quad(scene, {-0.7f, 0.9f, -0.4f}, {1.2f, 0.2f, 0.0f}, {0.0f, 0.0f, 0.8f},  // faces down, tilted
           add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(3.0f))));
  const View view = view_from({0.9f, 0.6f, 1.2f}, {0.0f, 0.0f, 0.0f}, 16, 16, 0.7f);
  const std::array<glm::dvec3, 4> corners = {
      glm::dvec3(-0.7, 0.9, -0.4), {0.5, 1.1, -0.4}, {0.5, 1.1, 0.4}, {-0.7, 0.9, 0.4}};
  expect_radiance(render(scene, view, 1024), [&](int x, int y) {
    const glm::dvec3 point = floor_point(view, x, y);
    if (std::max(std::abs(point.x), std::abs(point.z)) > 2.9) return 0.0;
    return albedo / pi * 3.0 * polygon_irradiance(corners, point, {0.0, 1.0, 0.0});
  });
}

TEST_CASE("A rectangle that nearly touches the plane is right, where the BSDF's rays carry the load", "[closed_form]") {
  Scene scene = floor_scene();
  add_quad(scene, {-0.5f, 0.02f, -0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f},
           add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(1.0f))));
  const View view = view_from({0.0f, 0.01f, 0.0f}, {0.0f, 0.0f, 0.0f}, 8, 8, 1.0f);  // from between the two
  const std::array<glm::dvec3, 4> corners = {
      glm::dvec3(-0.5, 0.02, -0.5), {0.5, 0.02, -0.5}, {0.5, 0.02, 0.5}, {-0.5, 0.02, 0.5}};
  expect_radiance(render(scene, view, 256), [&](int x, int y) {
    return albedo / pi * polygon_irradiance(corners, floor_point(view, x, y), {0.0, 1.0, 0.0});
  });
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
