// The builders of the project's own scenes: what holds of their geometry, colours and light.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "catch.h"
#include "error.h"
#include "make_scenes/builders.h"
#include "make_scenes/catalog.h"
#include "make_scenes/spectrum.h"
#include "scene/topology.h"

using namespace std::numbers;
using voxref::Object;
using voxref::Scene;
using voxref::SceneEntry;

namespace {

const Object& find_object(const Scene& scene, const std::string& name) {
  for (const Object& object : scene.objects)
    if (object.name == name) return object;
  throw voxref::Error(name, "no such object");
}

std::vector<glm::uvec3> object_triangles(const Scene& scene, const std::string& name) {
  const Object& object = find_object(scene, name);
  const auto first = scene.triangles.begin() + object.first_triangle;
  return {first, first + object.triangle_count};
}

glm::dvec3 area_vector(const Scene& scene, const glm::uvec3& t) {
  const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
  return 0.5 * glm::cross(b - a, c - a);
}

double object_area(const Scene& scene, const std::string& name) {
  double sum = 0.0;
  for (const glm::uvec3& t : object_triangles(scene, name)) sum += glm::length(area_vector(scene, t));
  return sum;
}

/// Whether every triangle of the object has `point` in front of it.
bool faces(const Scene& scene, const std::string& name, const glm::dvec3& point) {
  const auto triangles = object_triangles(scene, name);
  return std::all_of(triangles.begin(), triangles.end(), [&](const glm::uvec3& t) {
    return glm::dot(area_vector(scene, t), point - glm::dvec3(scene.positions[t.x])) > 0.0;
  });
}

double object_volume(const Scene& scene, const std::string& name) {
  return signed_volume(scene.positions, object_triangles(scene, name));
}

/// Solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983).
double solid_angle(const Scene& scene, const glm::uvec3& t) {
  const glm::dvec3 a = glm::normalize(glm::dvec3(scene.positions[t.x])),
                   b = glm::normalize(glm::dvec3(scene.positions[t.y])),
                   c = glm::normalize(glm::dvec3(scene.positions[t.z]));
  return 2.0 *
         std::atan2(std::abs(glm::dot(a, glm::cross(b, c))), 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

}  // namespace

TEST_CASE("Every scene is valid, has a camera, and normals that are unit and in front of their faces", "[scenes]") {
  for (const SceneEntry& entry : voxref::scene_catalog()) {
    INFO(entry.file);
    const Scene scene = voxref::build_scene(entry);
    CHECK_NOTHROW(voxref::validate(scene));
    CHECK(!scene.cameras.empty());
    CHECK((!scene.lights.empty() || scene.has_emission()));
    float length_error = 0.0f;
    for (const glm::vec3& n : scene.normals) length_error = std::max(length_error, std::abs(glm::length(n) - 1.0f));
    CHECK(length_error < 1e-6f);
    size_t behind = 0, empty = 0;
    for (const glm::uvec3& t : scene.triangles) {
      const glm::dvec3 face = area_vector(scene, t);
      if (!(glm::length(face) > 0.0)) ++empty;
      for (int k = 0; k < 3; ++k)
        if (!(glm::dot(face, glm::dvec3(scene.normals[t[k]])) > 0.0)) ++behind;
    }
    CHECK(behind == 0);
    CHECK(empty == 0);
    const bool glossy = entry.file == "glossy_spheres.glb";
    for (const voxref::Material& m : scene.materials)
      if (!glossy) CHECK((m.metallic == 0.0f && m.specular == 0.0f));
  }
}

TEST_CASE("The Cornell box has its published corners, faces its room and shows red on the left", "[scenes]") {
  const Scene scene = voxref::cornell_box(voxref::CornellLight::area);
  const glm::dvec3 middle(0.278, 0.2, 0.05);  // in front of both blocks
  for (const char* wall : {"floor", "ceiling", "back_wall", "right_wall", "left_wall", "lamp"})
    CHECK(faces(scene, wall, middle));
  // Corners as published, in metres, in double.
  const std::vector<glm::vec3> published = {{0.5528, 0, 0},        {0.5496, 0, 0.5592},    {0.556, 0.5488, 0},
                                            {0, 0.5488, 0.5592},   {0.343, 0.5488, 0.227}, {0.213, 0.5488, 0.332},
                                            {0.130, 0.165, 0.065}, {0.240, 0.165, 0.272},  {0.423, 0.330, 0.247},
                                            {0.314, 0.330, 0.456}, {0.290, 0, 0.114},      {0.472, 0, 0.406}};
  for (const glm::vec3& corner : published)
    CHECK(std::any_of(scene.positions.begin(), scene.positions.end(),
                      [&](const glm::vec3& p) { return glm::distance(p, corner) < 1e-6f; }));
  // Blocks stand on the floor without a bottom: four open edges. The divergence sum misses nothing, as the bottom is at
  // y = 0; base areas from the published corners by hand (shoelace), in m^2.
  struct Block {
    const char* name;
    double height, base;
  };
  for (const auto& [name, height, base] : {Block{"short_block", 0.165, 0.0276330}, {"tall_block", 0.330, 0.0276265}}) {
    const EdgeCounts counts = count_edges(scene.positions, object_triangles(scene, name));
    CHECK(counts.open == 4);
    CHECK(counts.tangled == 0);
    CHECK(object_volume(scene, name) == Approx(height * base).epsilon(1e-5));
  }
  // The shell is open towards the camera only: the edges of that opening are the only open ones.
  std::vector<glm::uvec3> shell;
  for (const char* wall : {"floor", "ceiling", "back_wall", "right_wall", "left_wall", "lamp"})
    for (const glm::uvec3& t : object_triangles(scene, wall)) shell.push_back(t);
  CHECK(count_edges(scene.positions, shell).open == 4);
  CHECK(count_edges(scene.positions, shell).tangled == 0);
  // The hole is the lamp's: 0.130 x 0.105, and ceiling and lamp together are the whole ceiling of the other variant.
  const Scene point = voxref::cornell_box(voxref::CornellLight::point);
  CHECK(object_area(scene, "lamp") == Approx(0.130 * 0.105).epsilon(1e-5));
  CHECK(object_area(scene, "lamp") + object_area(scene, "ceiling") ==
        Approx(object_area(point, "ceiling")).epsilon(1e-5));

  const glm::mat4 camera_from_world = glm::inverse(scene.cameras[0].world_from_camera);
  const auto on_screen = [&](const char* wall) {
    const glm::vec3 corner = scene.positions[object_triangles(scene, wall)[0].x];
    return glm::vec3(camera_from_world * glm::vec4(corner, 1.0f));
  };
  CHECK(on_screen("left_wall").x < 0.0f);
  CHECK(on_screen("right_wall").x > 0.0f);
  CHECK(on_screen("back_wall").z < -1.0f);  // the camera looks along its -Z
  const auto color_of = [&](const std::string& wall) {
    return scene.materials[find_object(scene, wall).material].base_color;
  };
  CHECK(color_of("left_wall").r > 4.0f * color_of("left_wall").g);
  CHECK(color_of("right_wall").g > 4.0f * color_of("right_wall").r);
  CHECK(2.0f * std::tan(0.5f * scene.cameras[0].yfov) == Approx(25.0f / 35.0f));  // film over focal length
}

TEST_CASE("Cornell's colours follow from the tabulated colour matching functions too", "[scenes]") {
  // CIE 1931 2 degree observer and D65 as tabulated, every 20 nm from 400 nm, with the same published spectra: another
  // observer (table, not fit) and another quadrature.
  constexpr std::array<std::array<double, 3>, 16> observer = {{{.01431, .000396, .06785},
                                                               {.13438, .0040, .6456},
                                                               {.34828, .0230, 1.74706},
                                                               {.2908, .0600, 1.6692},
                                                               {.09564, .13902, .81295},
                                                               {.0049, .3230, .2720},
                                                               {.06327, .7100, .07825},
                                                               {.2904, .9540, .0203},
                                                               {.5945, .9950, .0039},
                                                               {.9163, .8700, .0017},
                                                               {1.0622, .6310, .0008},
                                                               {.85445, .3810, .00019},
                                                               {.4479, .1750, .00002},
                                                               {.1649, .0610, 0},
                                                               {.04677, .0170, 0},
                                                               {.011359, .004102, 0}}};
  using Spectrum = std::array<double, 16>;
  constexpr Spectrum d65 = {82.75, 93.43, 104.87, 117.81, 115.92, 109.35, 104.79, 104.41,
                            100.0, 95.79, 90.01,  87.70,  83.70,  80.21,  78.28,  71.61};
  constexpr Spectrum flat = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  constexpr Spectrum lamp = {0,     1.6,   3.2,  4.8,   6.4,   8.0,   9.52,  11.04,
                             12.56, 14.08, 15.6, 16.16, 16.72, 17.28, 17.84, 18.4};
  constexpr Spectrum red = {.040, .050, .059, .062, .060, .058, .057, .059,
                            .067, .090, .287, .513, .609, .638, .642, .642};
  constexpr Spectrum green = {.092, .095, .097, .104, .125, .285, .472, .441,
                              .337, .266, .160, .126, .114, .120, .144, .159};
  const auto rgb = [&](const Spectrum& light, const Spectrum& reflectance) {
    glm::dvec3 xyz(0.0);
    for (size_t i = 0; i < observer.size(); ++i)
      for (int k = 0; k < 3; ++k) xyz[k] += light[i] * reflectance[i] * observer[i][k];
    return glm::dvec3(3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
                      -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
                      0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z);
  };
  double sensitivity = 0.0;
  for (const auto& row : observer) sensitivity += row[1];

  const voxref::CornellColors colors = voxref::cornell_colors();
  const glm::dvec3 lamp_radiance = rgb(lamp, flat) / sensitivity;
  for (int k = 0; k < 3; ++k) {
    // The fit's error is about 1 % of its peak, and so is that of 20 nm steps over spectra that bend at 500-620 nm.
    CHECK(colors.lamp_radiance[k] == Approx(lamp_radiance[k]).epsilon(0.02));
    CHECK(colors.red[k] == Approx(rgb(d65, red)[k] / rgb(d65, flat)[k]).margin(0.02));
    CHECK(colors.green[k] == Approx(rgb(d65, green)[k] / rgb(d65, flat)[k]).margin(0.02));
    CHECK(colors.white[k] > 0.70f);  // the measured range from 420 nm on
    CHECK(colors.white[k] < 0.78f);
  }
}

TEST_CASE("Closed rooms are closed, face inwards and hold their volume", "[scenes]") {
  struct Room {
    const char* name;
    Scene scene;
    double volume;
  };
  const float thickness = 0.1f;
  const double sphere =
      -signed_volume(voxref::sphere_furnace(0.5f, 3).positions, voxref::sphere_furnace(0.5f, 3).triangles);
  for (const auto& [name, scene, volume] :
       {Room{"furnace", voxref::furnace(0.5f), 8.0}, Room{"thin wall", voxref::thin_wall(thickness), 2.0 - thickness},
        Room{"sphere", voxref::sphere_furnace(0.5f, 3), sphere}}) {
    INFO(name);
    CHECK(count_edges(scene.positions, scene.triangles).closed());
    CHECK(volume > 0.0);
    CHECK(signed_volume(scene.positions, scene.triangles) == Approx(-volume).epsilon(1e-6));
  }
  const Scene light_box = voxref::light_box();
  CHECK(count_edges(light_box.positions, light_box.triangles).closed());
  // Convex, so nothing occludes: no vertex lies behind a face. Every 17th face is tried; 1e-6 is rounding to float.
  double deepest = 0.0;
  for (size_t i = 0; i < light_box.triangles.size(); i += 17) {
    const glm::dvec3 corner = light_box.positions[light_box.triangles[i].x];
    const glm::dvec3 normal = glm::normalize(area_vector(light_box, light_box.triangles[i]));
    for (const glm::vec3& p : light_box.positions)
      deepest = std::max(deepest, glm::dot(normal, corner - glm::dvec3(p)));
  }
  CHECK(deepest < 1e-6);
  const Scene plane_test = voxref::plane_test();
  CHECK(plane_test.triangles.size() == 24);  // the thesis's, table 4.2
  CHECK(object_volume(plane_test, "tall_box") == Approx(0.2 * 0.2 * 2.55).epsilon(1e-5));
}

TEST_CASE("The sphere furnace's facets receive the sphere's irradiance", "[scenes]") {
  // A facet's mean irradiance from 1 W/sr at the centre is its solid angle over its area.
  for (const int n : {3, 5}) {
    const Scene scene = voxref::sphere_furnace(0.5f, n);
    double area = 0.0, flux = 0.0, worst = 0.0;
    for (const glm::uvec3& t : scene.triangles) {
      const double facet = glm::length(area_vector(scene, t)), seen = solid_angle(scene, t);
      area += facet;
      flux += seen;
      worst = std::max(worst, std::abs(seen / facet - 1.0));
    }
    INFO(n);
    CHECK(flux == Approx(4.0 * pi).epsilon(1e-9));    // it closes around the light
    CHECK(flux / area == Approx(1.0).epsilon(1e-6));  // radii are rounded to float
    // Measured 0.09 % at 3 and 0.006 % at 5, as the square of the edge; scenes/README.md states 0.007 %.
    CHECK(worst < (n == 3 ? 1e-3 : 7e-5));
  }
}
