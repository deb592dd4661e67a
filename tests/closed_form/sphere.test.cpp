#include <cmath>
#include <numbers>

#include "catch.h"
#include "closed_form/expect.h"
#include "make_scenes/builders.h"

namespace voxref {

TEST_CASE("A point light at the centre of a sphere of albedo r gives radiance r I / (pi (1-r)) everywhere",
          "[closed_form]") {
  // The sphere is 20 x 4^6 triangles. Their area is 4 pi, so that the mean irradiance is exact; a point of a facet lies
  // at between 0.9998 and 1.0001 of the radius, which the pixels' directions average over. The error left is below 0.02
  // %:
  constexpr double facets = 2e-4;
  for (const float albedo : {0.5f, 0.9f}) {
    const Scene scene = sphere_furnace(albedo, 6);
    double nearest = 2.0, farthest = 0.0;
    for (const glm::uvec3& t : scene.triangles) {
      const glm::dvec3 center =
          (glm::dvec3(scene.positions[t.x]) + glm::dvec3(scene.positions[t.y]) + glm::dvec3(scene.positions[t.z])) /
          3.0;
      nearest = std::min(nearest, glm::length(center));
      farthest = std::max(farthest, glm::length(glm::dvec3(scene.positions[t.x])));
    }
    CAPTURE(nearest, farthest);
    CHECK((farthest - nearest) < 2.0 * facets);  // irradiance goes with the square, its mean lies in the middle
    View view = view_from({0.3f, 0.2f, -0.1f}, {-1.0f, 0.1f, 0.2f}, 16, 16, 1.8f);
    view.pixel = PixelSampling::box;
    const PathResult result = render(scene, view, albedo < 0.6f ? 256 : 640);
    const double r = albedo;
    expect_radiance(
        result, [&](int, int) { return r / (std::numbers::pi * (1.0 - r)); }, facets);
  }
}

}  // namespace voxref
