#include "reference/radiosity.h"

#include <cmath>

#include "catch.h"
#include "make_scenes/builders.h"
#include "reference/small_scenes.h"

// What this cannot see: errors of glossy surfaces, textures and shading normals (there are none), of what happens
// within 0.1 m of an edge, and of anything that both take from the Scene.
namespace voxref {

namespace {

/// The box as the path tracer and as three ever finer radiosity solutions see it, over the pixels whose surface is at
/// least `clearance` from the next one.
struct Comparison {
  static constexpr double clearance = 0.1;  // metres: two elements of the middle mesh, three of the finest

  Comparison(bool blocks, int spp) {
    const Scene scene = cornell_box(CornellLight::area, blocks);
    View view;
    view.camera = scene.cameras[0];
    view.width = view.height = 16;
    const PathResult traced = render(scene, view, spp);
    std::vector<std::string> occluders;
    if (blocks) occluders = {"short_block", "tall_block"};
    const Radiosity coarse(scene, occluders, 0), middle(scene, occluders, 1), fine(scene, occluders, 2);
    const RayGenerator rays(view);
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const Ray ray = rays({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
        const auto truth = fine.radiance(ray.origin, ray.direction, clearance);
        if (!truth) continue;
        add(traced.image, static_cast<size_t>(y * view.width + x), *truth,
            *middle.radiance(ray.origin, ray.direction, 0.0), *coarse.radiance(ray.origin, ray.direction, 0.0));
      }
    for (int c = 0; c < 3; ++c) {
      deviation[c] /= pixels;
      error[c] = std::sqrt(error[c]) / pixels;
      last_change[c] /= pixels;
      change_before[c] /= pixels;
      scatter[c] = std::sqrt(scatter[c] / pixels);
      noise[c] = std::sqrt(noise[c] / pixels);
    }
  }

  int pixels = 0;
  // Per channel, relative to the finest solution: mean deviation of the path tracer and its standard error; change of
  // the mean by the last refinement and by the one before; root mean square of the pixels' deviations, and how much of
  // it noise explains.
  glm::dvec3 deviation{0.0}, error{0.0}, last_change{0.0}, change_before{0.0}, scatter{0.0}, noise{0.0};

 private:
  void add(const Image& image, size_t pixel, const glm::dvec3& fine, const glm::dvec3& middle,
           const glm::dvec3& coarse) {
    ++pixels;
    const auto direct = image.layer("direct"), indirect = image.layer("indirect"), stderrs = image.layer("stderr");
    for (int c = 0; c < 3; ++c) {
      const double value = (double{direct[c][pixel]} + double{indirect[c][pixel]}) / fine[c] - 1.0;
      const double one_error = stderrs[c][pixel] / fine[c];
      deviation[c] += value;
      error[c] += one_error * one_error;
      last_change[c] += middle[c] / fine[c] - 1.0;
      change_before[c] += (coarse[c] - middle[c]) / fine[c];
      scatter[c] += value * value;
      noise[c] += one_error * one_error;
    }
  }
};

/// The path tracer agrees within three standard errors and what radiosity itself may be off.
/// @param correction of the finest solution, relative @param own_error what that leaves
/// @param bias of the mean, relative, that would be found with probability 0.9 however the two errors fall together
void expect_agreement(const Comparison& comparison, const glm::dvec3& correction, const glm::dvec3& own_error,
                      double bias) {
  for (int c = 0; c < 3; ++c) {
    const double deviation = comparison.deviation[c] - correction[c], error = comparison.error[c], own = own_error[c];
    CAPTURE(c, comparison.pixels, deviation, error, own);
    CHECK(std::abs(deviation) < 3.0 * error + own);
    CHECK((3.0 + 1.28) * error + 2.0 * own < bias);
  }
}

}  // namespace

TEST_CASE("Radiosity in a closed room of one colour is emission over one less albedo", "[radiosity]") {
  // The row of form factors from a point in a closed room sums to 1 exactly, by Lambert's formula, whatever the mesh.
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert(glm::vec3(0.5f, 0.25f, 0.8f), glm::vec3(2.0f))));
  for (glm::vec3& position : scene.positions) position *= 0.25f;  // some 100 elements: they have a size in metres
  const Radiosity room(scene, {}, 0);
  const auto reflected = room.radiance(glm::dvec3(0.02, 0.05, 0.07), glm::dvec3(0.3, -1.0, 0.2), 0.0);
  REQUIRE(reflected);
  CHECK(reflected->r == Approx(2.0 * 0.5 / 0.5).epsilon(1e-6));  // the sweeps end at 1e-7
  CHECK(reflected->g == Approx(2.0 * 0.25 / 0.75).epsilon(1e-6));
  CHECK(reflected->b == Approx(2.0 * 0.8 / 0.2).epsilon(2e-6));
}

TEST_CASE("The path tracer agrees with radiosity in the empty Cornell box", "[radiosity]") {
  // Nothing throws shadows: of second order, four times less with each refinement (measured: 4.8), so that a third of
  // the last change is still missing. Richardson's extrapolation takes it off; as much again is granted for its own
  // error.
  const Comparison comparison(false, 8192);
  for (int c = 0; c < 3; ++c) CHECK(comparison.change_before[c] > 3.5 * std::abs(comparison.last_change[c]));
  const glm::dvec3 missing = comparison.last_change / 3.0;
  expect_agreement(comparison, -missing, glm::abs(missing), 0.003);
  // Pixel by pixel too: noise explains what differs but for 0.2 % of each pixel.
  for (int c = 0; c < 3; ++c) CHECK(comparison.scatter[c] < std::hypot(1.2 * comparison.noise[c], 0.002));
}

TEST_CASE("The path tracer agrees with radiosity in the Cornell box with its blocks", "[radiosity]") {
  // Elements do not follow the shadows' edges, so that changes by refinement have either sign and no order: the last
  // one stands for the error that is left.
  const Comparison comparison(true, 8192);
  expect_agreement(comparison, glm::dvec3(0.0), glm::abs(comparison.last_change), 0.008);
}

}  // namespace voxref
