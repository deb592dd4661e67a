// Light sampling on against off: the path tracer, and a plain one without light sampling, without multiple importance
// sampling and without roulette, agree in the mean.
//
// The two share the scene, the ray caster, Surfaces and evaluate(): what is wrong there is wrong in both, and so is
// what changes no mean over an image; that is left to the closed forms and to the radiosity solution.
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "catch.h"
#include "compare/statistics.h"
#include "make_scenes/builders.h"
#include "parallel.h"
#include "reference/small_scenes.h"
#include "scene/surface.h"

namespace voxref {

namespace {

constexpr double pi = std::numbers::pi;

/// Follows light from the camera by cosine-distributed directions alone; random numbers of the standard library.
class PlainTracer {
 public:
  explicit PlainTracer(const Scene& scene) : caster_(scene), surfaces_(scene) {}

  /// Mean over all pixels of light that is scattered up to `depth` times, per channel. @param samples per pixel
  std::array<Estimate, 3> mean(const View& view, int depth, int samples) const {
    const auto pixels = static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
    std::vector<glm::dvec3> sums(pixels, glm::dvec3(0.0)), squares = sums;
    const RayGenerator rays(view);
    parallel_for(pixels, 1, [&](size_t i, size_t) {
      std::mt19937_64 random(i);
      const auto width = static_cast<size_t>(view.width);
      const Ray ray = rays(glm::vec2(i % width, i / width) + 0.5f);
      for (int k = 0; k < samples; ++k) {
        const glm::dvec3 value = radiance(ray, depth, random);
        sums[i] += value;
        squares[i] += value * value;
      }
    });
    // Strata: each pixel's own mean has its own variance.
    std::array<Estimate, 3> means;
    const double n = samples, count = static_cast<double>(pixels);
    for (int c = 0; c < 3; ++c) {
      double variance = 0.0;
      for (size_t i = 0; i < pixels; ++i) {
        const double mean = sums[i][c] / n;
        means[c].mean += mean / count;
        variance += (squares[i][c] / n - mean * mean) / (n - 1.0);
      }
      means[c].error = std::sqrt(variance) / count;
    }
    return means;
  }

 private:
  glm::dvec3 radiance(Ray ray, int depth, std::mt19937_64& random) const {
    glm::dvec3 light(0.0), throughput(1.0);
    std::uniform_real_distribution<double> uniform;
    for (;; --depth) {
      const Hit hit = caster_.closest(ray);
      if (!hit) return light;
      const glm::vec3 out = -glm::normalize(ray.direction);
      const SurfacePoint point = surfaces_.point(hit, out);
      light += throughput * glm::dvec3(point.emission);
      if (depth == 0) return light;
      // Cosine-distributed about the shading normal: a point of the unit sphere around the normal's tip.
      const double z = 2.0 * uniform(random) - 1.0, angle = 2.0 * pi * uniform(random), r = std::sqrt(1.0 - z * z);
      const glm::vec3 in =
          glm::normalize(glm::dvec3(point.shading_normal) + glm::dvec3(r * std::cos(angle), r * std::sin(angle), z));
      if (glm::dot(point.geometric_normal, in) <= 0.0f) return light;
      throughput *= pi * glm::dvec3(evaluate(point.reflectance, point.shading_normal, out, in));
      if (throughput == glm::dvec3(0.0)) return light;
      ray = caster_.leave(point.position, point.geometric_normal, in);
    }
  }

  Caster caster_;
  Surfaces surfaces_;
};

/// Welch's test of each channel's mean at 0.1 % each. @param bias of the mean that it must find with probability 0.9
void expect_same_mean(const Scene& scene, const View& view, int depth, int spp, int plain_spp, double bias) {
  const PathResult traced = render(scene, view, spp, depth);
  CHECK(traced.nonfinite == 0);
  const std::array<Estimate, 3> plain = PlainTracer(scene).mean(view, depth, plain_spp);
  for (int c = 0; c < 3; ++c) {
    const Welch test({traced.mean[c], traced.mean_stderr[c]}, plain[c]);
    const double found = test.detectable(0.001) / plain[c].mean, difference = test.difference / plain[c].mean;
    CAPTURE(c, difference, found);
    CHECK(test.p() > 0.001);
    CHECK(found < bias);
  }
}

/// A white room with a large lamp under the ceiling, of the given material, and a shelf of another.
Scene room(const Material& lamp, const Material& shelf) {
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert({0.7f, 0.6f, 0.5f})));
  add_quad(scene, {-0.9f, -0.5f, -0.4f}, {0.0f, 0.0f, 0.8f}, {0.8f, 0.0f, 0.0f}, add_material(scene, shelf));
  add_quad(scene, {-0.7f, 0.9f, -0.7f}, {1.4f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.4f}, add_material(scene, lamp));
  return scene;
}

View room_view() { return view_from({0.0f, 0.0f, 0.95f}, {0.0f, -0.2f, 0.0f}, 24, 24, 1.6f); }

Material glossy(float metallic, float roughness) {
  Material material;
  material.base_color = {0.9f, 0.7f, 0.4f, 1.0f};
  material.metallic = metallic;
  material.roughness = roughness;
  return material;
}

}  // namespace

TEST_CASE("With and without light sampling the mean is the same under a large lamp", "[path]") {
  const Scene scene = room(lambert(glm::vec3(0.2f), glm::vec3(5.0f)), glossy(0.5f, 0.4f));
  expect_same_mean(scene, room_view(), 3, 128, 3000, 0.009);
}

TEST_CASE("With and without light sampling the mean is the same under a hundred emissive triangles", "[path]") {
  // 7 x 7 lamps tilted to all sides, half of them of nine times the brightness: the choice among them must be weighed
  // right.
  Scene scene = room(lambert(glm::vec3(0.2f)), glossy(0.5f, 0.4f));
  const uint32_t dim = add_material(scene, lambert(glm::vec3(0.2f), glm::vec3(2.0f)));
  const uint32_t bright = add_material(scene, lambert(glm::vec3(0.2f), glm::vec3(18.0f)));
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j) {
      const float tilt = 0.05f * static_cast<float>((i + 2 * j) % 5 - 2);
      add_quad(scene, {-0.9f + 0.25f * static_cast<float>(i), 0.6f, -0.9f + 0.25f * static_cast<float>(j)},
               {0.22f, tilt, 0.0f}, {0.0f, -tilt, 0.22f}, (i + j) % 2 ? dim : bright);
    }
  expect_same_mean(scene, room_view(), 3, 128, 3000, 0.02);
}

TEST_CASE("With and without light sampling the mean is the same where all is glossy", "[path]") {
  Scene scene = room(lambert(glm::vec3(0.2f), glm::vec3(5.0f)), glossy(1.0f, 0.3f));
  scene.materials[0] = glossy(0.0f, 0.5f);  // the walls: plastic
  expect_same_mean(scene, room_view(), 3, 128, 3000, 0.018);
}

TEST_CASE("With and without light sampling the mean is the same under a textured lamp with holes", "[path]") {
  // Texels of very different radiance, filtered, sRGB; a quarter of the lamp is cut out by its base colour's alpha.
  Material lamp = lambert(glm::vec3(0.5f), glm::vec3(8.0f));
  lamp.base_color_texture.image = lamp.emission_texture.image = 0;
  lamp.emission_texture.srgb = true;
  lamp.alpha_mode = AlphaMode::mask;
  lamp.double_sided = true;
  Scene scene = room(lamp, glossy(0.5f, 0.4f));
  TextureImage image;
  image.width = image.height = 4;
  for (int i = 0; i < 16; ++i) {
    const auto value = static_cast<uint8_t>(i * 97 % 256);
    const auto alpha = static_cast<uint8_t>(i % 4 < 2 && i < 8 ? 0 : 255);
    image.texels8.insert(image.texels8.end(), {value, static_cast<uint8_t>(255 - value), 200, alpha});
  }
  scene.images.push_back(image);
  scene.uv[0].assign(scene.positions.size(), glm::vec2(0.5f));
  const std::array<glm::vec2, 4> corners = {glm::vec2(0.0f, 0.0f), {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}};
  std::copy(corners.begin(), corners.end(), scene.uv[0].end() - 4);
  expect_same_mean(scene, room_view(), 3, 128, 3000, 0.016);
}

TEST_CASE("With and without light sampling the mean is the same in Cornell's box and on its glossy spheres",
          "[path][.long]") {
  // Narrow lobes find a small lamp by luck where lights are not sampled: of the spheres, 8 % is all that can be asked
  // for.
  for (const auto& [scene, bias] : {std::pair(cornell_box(CornellLight::area), 0.01), {glossy_spheres(), 0.08}}) {
    View view;
    view.camera = scene.cameras[0];
    view.width = view.height = 24;
    expect_same_mean(scene, view, 3, 1024, 10000, bias);
  }
}

}  // namespace voxref
