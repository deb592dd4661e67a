// Luminaires of constant radiance: Lambert's polygon formula, and the form factors of two rectangles that follow from
// it. What none of these can see: light that is scattered twice (there is none), and luminaires that vary.
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include "catch.h"
#include "closed_form/expect.h"
#include "closed_form/polygon.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

constexpr double pi = std::numbers::pi;
constexpr float albedo = 0.6f;
constexpr glm::dvec3 up(0.0, 1.0, 0.0);

Scene floor_scene() {
  Scene scene;
  add_floor(scene, 3.0f, add_material(scene, lambert(glm::vec3(albedo))));
  return scene;
}

uint32_t add_luminaire(Scene& scene, float radiance) {
  return add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(radiance)));
}

/// From the side, under the luminaires.
View side_view() { return view_from({0.9f, 0.6f, 1.2f}, {0.0f, 0.0f, 0.0f}, 16, 16, 0.7f); }

bool on_floor(const glm::dvec3& point) { return std::max(std::abs(point.x), std::abs(point.z)) < 2.9; }

/// Straight down on exactly the rectangle [0,width] x [0,depth] of the floor, from a height of 0.1.
/// @param width in sixteenths of the depth
View view_of_rectangle(float width, float depth) {
  View view = view_from({0.5f * width, 0.1f, 0.5f * depth}, {0.5f * width, 0.0f, 0.5f * depth}, 16, 16);
  view.camera.orthographic = true;
  view.camera.ymag = 0.5f * depth;
  view.camera.aspect = width / depth;
  view.width = static_cast<int>(std::lround(16.0f * width / depth));
  view.pixel = PixelSampling::box;
  return view;
}

const std::array<glm::dvec3, 4> tilted_rectangle = {
    glm::dvec3(-0.7, 0.9, -0.4), {0.5, 1.1, -0.4}, {0.5, 1.1, 0.4}, {-0.7, 0.9, 0.4}};

void add_tilted_rectangle(Scene& scene, float radiance) {  // faces down
  add_quad(scene, {-0.7f, 0.9f, -0.4f}, {1.2f, 0.2f, 0.0f}, {0.0f, 0.0f, 0.8f}, add_luminaire(scene, radiance));
}

}  // namespace

TEST_CASE("A rectangle luminaire over a plane gives Lambert's polygon formula", "[closed_form]") {
  Scene scene = floor_scene();
  add_tilted_rectangle(scene, 3.0f);
  const View view = side_view();
  expect_radiance(render(scene, view, 256), [&](int x, int y) {
    const glm::dvec3 point = floor_point(view, x, y);
    return on_floor(point) ? albedo / pi * 3.0 * polygon_irradiance(tilted_rectangle, point, up) : 0.0;
  });
}

TEST_CASE("A luminaire of seven corners gives Lambert's polygon formula", "[closed_form]") {
  // In a tilted plane and not convex, so that its triangles differ in size and the formula's edges turn both ways.
  Scene scene = floor_scene();
  const glm::dvec3 origin(0.1, 1.0, 0.0), right(0.9, 0.3, 0.0), forward(0.0, 0.2, 0.8);
  const std::array<glm::dvec2, 7> outline = {
      glm::dvec2(-0.7, -0.6), {0.0, -0.2}, {0.6, -0.5}, {0.8, 0.3}, {0.2, 0.7}, {-0.3, 0.4}, {-0.8, 0.5}};
  std::array<glm::dvec3, 7> corners;
  const glm::dvec3 normal = glm::normalize(glm::cross(right, forward));
  for (size_t i = 0; i < corners.size(); ++i) {
    corners[i] = origin + outline[i].x * right + outline[i].y * forward;
    scene.positions.emplace_back(corners[i]);
    scene.normals.emplace_back(normal);
  }
  const uint32_t material = add_luminaire(scene, 2.0f);
  const uint32_t first = 4;  // after the floor's corners
  scene.objects.push_back({"heptagon", 2, 5, material, false});
  for (const glm::uvec3 t : {glm::uvec3(0, 1, 6), {1, 5, 6}, {1, 4, 5}, {1, 3, 4}, {1, 2, 3}}) {
    scene.triangles.push_back(t + first);
    scene.triangle_materials.push_back(material);
  }
  REQUIRE(normal.y < 0.0);  // it faces the floor
  const View view = side_view();
  expect_radiance(render(scene, view, 1024), [&](int x, int y) {
    const glm::dvec3 point = floor_point(view, x, y);
    // Behind the luminaire's plane the formula holds for its back, which gives nothing.
    const bool lit = on_floor(point) && glm::dot(normal, point - origin) > 0.0;
    return lit ? albedo / pi * 2.0 * polygon_irradiance(corners, point, up) : 0.0;
  });
}

TEST_CASE("A rectangle that nearly touches the plane is right, where the BSDF's rays carry the load", "[closed_form]") {
  Scene scene = floor_scene();
  add_quad(scene, {-0.5f, 0.02f, -0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, add_luminaire(scene, 1.0f));
  const View view = view_from({0.0f, 0.01f, 0.0f}, {0.0f, 0.0f, 0.0f}, 8, 8, 1.0f);  // from between the two
  const std::array<glm::dvec3, 4> corners = {
      glm::dvec3(-0.5, 0.02, -0.5), {0.5, 0.02, -0.5}, {0.5, 0.02, 0.5}, {-0.5, 0.02, 0.5}};
  expect_radiance(render(scene, view, 1024),
                  [&](int x, int y) { return albedo / pi * polygon_irradiance(corners, floor_point(view, x, y), up); });
}

TEST_CASE("A textured luminaire with a hole gives the sum of its texels' rectangles", "[closed_form]") {
  // Unfiltered texels are rectangles of constant radiance. 0, 255 and 51 of 255, and a masked texel, which is a hole.
  Scene scene = floor_scene();
  TextureImage image;
  image.width = image.height = 2;
  image.texels8 = {255, 255, 255, 255, 51, 51, 51, 255, 0, 0, 0, 255, 255, 255, 255, 0};
  scene.images.push_back(image);
  Material material = lambert(glm::vec3(0.0f), glm::vec3(5.0f));
  material.emission_texture.image = material.base_color_texture.image = 0;
  material.emission_texture.nearest = material.base_color_texture.nearest = true;
  material.alpha_mode = AlphaMode::mask;
  const glm::dvec3 corner(-0.6, 0.9, -0.5), u(1.2, 0.2, 0.0), v(0.0, 0.1, 1.0);
  add_quad(scene, corner, u, v, add_material(scene, material));
  scene.uv[0] = {{0.0f, 0.0f}, {0.0f, 0.0f}, {0.0f, 0.0f}, {0.0f, 0.0f},  // the floor's
                 {0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}};
  const View view = side_view();
  expect_radiance(render(scene, view, 2048), [&](int x, int y) {
    const glm::dvec3 point = floor_point(view, x, y);
    if (!on_floor(point)) return 0.0;
    double irradiance = 0.0;
    for (const auto& [column, row, radiance] : {std::tuple(0.0, 0.0, 5.0), {0.5, 0.0, 1.0}}) {
      const glm::dvec3 a = corner + column * u + row * v, du = 0.5 * u, dv = 0.5 * v;
      irradiance += radiance * polygon_irradiance(std::array{a, a + du, a + du + dv, a + dv}, point, up);
    }
    return albedo / pi * irradiance;
  });
}

TEST_CASE("Two parallel rectangles exchange what their form factor says", "[closed_form]") {
  // Opposite each other, X = a / c and Y = b / c: Howell, A Catalog of Radiation Heat Transfer Configuration Factors,
  // C-11. The framed part of the floor is the receiver, and its mean radiance albedo x F.
  const double a = 1.5, b = 1.0, c = 0.75, x = a / c, y = b / c;
  const double sx = std::sqrt(1.0 + x * x), sy = std::sqrt(1.0 + y * y);
  const double factor = 2.0 / (pi * x * y) *
                        (std::log(sx * sy / std::sqrt(1.0 + x * x + y * y)) + x * sy * std::atan(x / sy) +
                         y * sx * std::atan(y / sx) - x * std::atan(x) - y * std::atan(y));
  Scene scene = floor_scene();
  add_quad(scene, glm::vec3(0.0, c, 0.0), glm::vec3(a, 0.0, 0.0), glm::vec3(0.0, 0.0, b), add_luminaire(scene, 1.0f));
  expect_mean(render(scene, view_of_rectangle(1.5f, 1.0f), 512), albedo * factor);
}

TEST_CASE("Two perpendicular rectangles with a common edge exchange what their form factor says", "[closed_form]") {
  // Edge l = 1, floor w, wall h: Howell C-14.
  const double w = 0.75, h = 0.6, w2 = w * w, h2 = h * h, d = std::sqrt(h2 + w2);
  const double sum = 1.0 + w2 + h2;
  const double logarithm = std::log((1.0 + w2) * (1.0 + h2) / sum) +
                           w2 * std::log(w2 * sum / ((1.0 + w2) * (w2 + h2))) +
                           h2 * std::log(h2 * sum / ((1.0 + h2) * (h2 + w2)));
  const double factor =
      1.0 / (pi * w) * (w * std::atan(1.0 / w) + h * std::atan(1.0 / h) - d * std::atan(1.0 / d) + 0.25 * logarithm);
  Scene scene = floor_scene();
  add_quad(scene, glm::vec3(0.0f), glm::vec3(0.0, h, 0.0), glm::vec3(0.0f, 0.0f, 1.0f), add_luminaire(scene, 1.0f));
  expect_mean(render(scene, view_of_rectangle(0.75f, 1.0f), 8192), albedo * factor);
}

TEST_CASE("All kinds of light together give the sum of what each gives", "[closed_form]") {
  // A rectangle; a point light below it; a sun so low that the rectangle's shadow falls beyond the floor; a background,
  // of which the rectangle hides as much as it would give itself with the same radiance.
  Scene scene = floor_scene();
  add_tilted_rectangle(scene, 3.0f);
  Light point;
  point.position = {0.3f, 0.5f, 0.6f};
  point.intensity = glm::vec3(0.5f);
  Light sun;
  sun.type = LightType::directional;
  sun.direction = glm::normalize(glm::vec3(-0.1f, -0.2f, -1.0f));
  sun.intensity = glm::vec3(4.0f);
  scene.lights = {point, sun};
  View view = side_view();
  view.background = glm::vec3(0.7f);
  expect_radiance(render(scene, view, 512), [&](int x, int y) {
    const glm::dvec3 at = floor_point(view, x, y), d = glm::dvec3(point.position) - at;
    if (!on_floor(at)) return 0.0;
    const double rectangle = polygon_irradiance(tilted_rectangle, at, up);
    const double irradiance = 3.0 * rectangle + 0.5 * d.y / std::pow(glm::length(d), 3.0) -
                              4.0 * static_cast<double>(sun.direction.y) + 0.7 * (pi - rectangle);
    return albedo / pi * irradiance;
  });
}

}  // namespace voxref
