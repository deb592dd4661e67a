// Unit sphere of albedo r with a point light I = 1 at its centre. What these cannot see: a wrong distribution of
// directions that keeps its mean (all of the sphere is equally bright), and anything emissive.
#include <array>
#include <cmath>
#include <numbers>

#include "catch.h"
#include "closed_form/expect.h"
#include "make_scenes/builders.h"

namespace voxref {

namespace {

// 20 x 4^5 triangles, whose area is exactly 4 pi.
constexpr int subdivisions = 5;

/// Three places from which to look in three directions: together they see most of the sphere.
std::array<View, 3> views() {
  return {view_from({0.3f, 0.2f, -0.1f}, {-1.0f, 0.1f, 0.2f}, 8, 8, 1.8f),
          view_from({-0.6f, -0.5f, 0.3f}, {1.0f, 0.6f, 0.4f}, 8, 8, 1.8f),
          view_from({0.0f, 0.1f, 0.9f}, {0.1f, 0.0f, -1.0f}, 8, 8, 1.8f)};
}

/// Direct irradiance of the facet that a pixel's centre sees, I cos / d^2, from its corners in float64.
double direct_irradiance(const Scene& scene, const Caster& caster, const View& view, int x, int y) {
  const Ray ray = RayGenerator(view)({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
  const Hit hit = caster.closest(ray);
  REQUIRE(hit);
  const glm::uvec3 corners = scene.triangles[hit.triangle];
  const glm::dvec3 a = scene.positions[corners.x], b = scene.positions[corners.y], c = scene.positions[corners.z];
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const glm::dvec3 origin(ray.origin), direction(ray.direction);
  const glm::dvec3 point = origin + direction * (glm::dot(a - origin, normal) / glm::dot(direction, normal));
  const double distance = glm::length(point);
  return std::abs(glm::dot(normal, point)) / std::pow(distance, 3.0);
}

/// Total irradiance I / (1-r). Indirect light is the same everywhere in a sphere, r / (1-r) of the mean irradiance,
/// which for these facets is exactly 1; the point's own facet decides its direct share.
void expect_total(float albedo, int spp) {
  // That facets send their light as a sphere does is right to the square of their size: of some 1e-3 at the worst
  // facet, about a tenth is left in what all of them together send to a point.
  constexpr double facets = 1e-4;
  const Scene scene = sphere_furnace(albedo, subdivisions);
  const Caster caster(scene);
  const double r = albedo;
  PathOptions options;
  options.spp = spp;
  for (const View& view : views()) {
    ++options.seed;
    expect_radiance(
        path_trace(scene, caster, view, options),
        [&](int x, int y) {
          return r / std::numbers::pi * (direct_irradiance(scene, caster, view, x, y) + r / (1.0 - r));
        },
        facets);
  }
}

}  // namespace

TEST_CASE("A point light at the centre of a unit sphere gives irradiance I at every point", "[closed_form]") {
  const Scene scene = sphere_furnace(0.5f, subdivisions);
  const Caster caster(scene);
  double least = 2.0, most = 0.0;
  for (const View& view : views())
    expect_radiance(render(scene, view, 2, 1), [&](int x, int y) {
      const double irradiance = direct_irradiance(scene, caster, view, x, y);
      least = std::min(least, irradiance);
      most = std::max(most, irradiance);
      return 0.5 / std::numbers::pi * irradiance;
    });
  // Facets are off by the square of their size: the sphere's own answer, 1, at every point to within 0.2 %.
  CAPTURE(least, most);
  CHECK(least > 1.0 - 2e-3);
  CHECK(most < 1.0 + 2e-3);
}

TEST_CASE("A point light at the centre of a sphere of albedo 0.5 gives twice the irradiance in all at every point",
          "[closed_form]") {
  expect_total(0.5f, 5000);
}

TEST_CASE("A point light at the centre of a sphere of albedo 0.8 gives five times the irradiance in all at every point",
          "[closed_form][.long]") {
  expect_total(0.8f, 10000);
}

}  // namespace voxref
