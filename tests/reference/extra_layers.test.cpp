// Layers against sums, differences and closed forms of the same renderer: light that is wrong in a layer and in the
// whole alike is not seen here, but by the closed forms of the whole; noise hides 3 % of the furnace's bounces.
#include "reference/extra_layers.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include "catch.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

PathResult render_layers(const Scene& scene, const View& view, int spp, std::optional<int> max_depth,
                         const ExtraLayers& extra) {
  validate(scene);
  const Caster caster(scene);
  PathOptions options;
  options.spp = spp;
  options.max_depth = max_depth;
  options.extra = extra;
  return path_trace(scene, caster, view, options);
}

double mean_of(const Image& image, const std::string& channel) {
  double sum = 0.0;
  for (const float value : image.channel(channel)) sum += value;
  return sum / static_cast<double>(image.pixel_count());
}

}  // namespace

TEST_CASE("Bounces add up to the indirect light, and each is what one more bounce adds", "[extra_layers]") {
  const Scene scene = lit_room();
  const View view = view_from({0.0f, 0.0f, 0.95f}, {0.0f, 0.2f, 0.0f}, 12, 12, 1.6f);
  const Image image = render_layers(scene, view, 20, 4, {.bounces = 4, .irradiance = false}).image;
  for (const char* c : {"R", "G", "B"}) {
    const auto indirect = image.channel(channel_name("indirect", c));
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      double sum = 0.0;
      for (const char* bounce : {"bounce.1", "bounce.2", "bounce.3"}) sum += image.channel(channel_name(bounce, c))[i];
      // Each of three layers is rounded to float32 in each pass and at the end.
      CHECK(sum == Approx(indirect[i]).epsilon(1e-6));
      CHECK(image.channel(channel_name("bounce.4", c))[i] == 0.0f);  // three bounces are all that --max-depth 4 lets by
    }
  }
  for (int depth = 2; depth <= 4; ++depth) {
    const double more = mean_of(render(scene, view, 20, depth).image, "indirect.G");
    const double less = mean_of(render(scene, view, 20, depth - 1).image, "indirect.G");
    // A difference of means rounded to float32.
    CHECK(mean_of(image, "bounce." + std::to_string(depth - 1) + ".G") == Approx(more - less).margin(1e-6 * more));
  }
}

TEST_CASE("Asking for extra layers leaves the others as they are, to the bit", "[extra_layers]") {
  const View view = view_from({0.0f, 0.0f, 0.95f}, {0.0f, 0.2f, 0.0f}, 12, 12, 1.6f);
  const PathResult plain = render_layers(lit_room(), view, 20, std::nullopt, {});
  const PathResult extra = render_layers(lit_room(), view, 20, std::nullopt, {.bounces = 2, .irradiance = true});
  for (const std::string& name : plain.image.channels()) {
    CAPTURE(name);
    const auto a = plain.image.channel(name), b = extra.image.channel(name);
    CHECK(std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
  }
  CHECK(!plain.image.has("bounce.1.R"));
  CHECK(!plain.image.has("irradiance.R"));
  CHECK(plain.rays < extra.rays);
}

TEST_CASE("In a uniform furnace bounces are powers of the albedo, and irradiance is pi times the radiance",
          "[extra_layers]") {
  // Walls that emit 1 and reflect r: bounce k carries r^(k+1), the sum of all 1 / (1 - r) arrives from everywhere.
  const float r = 0.5f;
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert(glm::vec3(r), glm::vec3(1.0f))));
  const View view = view_from({0.1f, 0.2f, 0.3f}, {0.0f, 0.0f, -1.0f}, 8, 8, 1.2f);
  const Image image = render_layers(scene, view, 512, std::nullopt, {.bounces = 3, .irradiance = true}).image;
  // 32768 samples whose spread is at most that of their mean: 0.6 % each, five of them and some for light sampling.
  for (int k = 1; k <= 3; ++k)
    CHECK(mean_of(image, "bounce." + std::to_string(k) + ".G") == Approx(std::pow(r, k + 1)).epsilon(0.03));
  CHECK(mean_of(image, "irradiance.G") == Approx(std::numbers::pi / (1.0 - r)).epsilon(0.03));
}

TEST_CASE("Irradiance does not depend on what the surface makes of it", "[extra_layers]") {
  // A light of 3 W/sr 2 m above the floor: I / d^2, on a mirror-like metal as on a black wall.
  for (const float albedo : {0.0f, 0.8f}) {
    Scene scene;
    Material metal;
    metal.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    metal.metallic = albedo > 0.0f ? 1.0f : 0.0f;
    metal.specular = albedo;
    metal.roughness = 0.1f;
    add_floor(scene, 1.0f, add_material(scene, metal));
    Light light;
    light.position = {0.0f, 2.0f, 0.0f};
    light.intensity = glm::vec3(3.0f);
    scene.lights.push_back(light);
    View view = view_from({0.0f, 1.0f, 0.0f}, glm::vec3(0.0f), 1, 1, 0.01f);
    CHECK(render_layers(scene, view, 4, std::nullopt, {.bounces = 0, .irradiance = true})
              .image.channel("irradiance.G")[0] == Approx(0.75f).epsilon(1e-5));
    view = view_from({1.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 1, 1, 0.01f);
    view.pixel = PixelSampling::box;
    // On the edge, where half of the pixel misses the floor: irradiance is of the surface, not of the pixel.
    // I cos / d^2 = 3 x (2 / sqrt 5) / 5, over 5 mm.
    CHECK(render_layers(scene, view, 16, std::nullopt, {.bounces = 0, .irradiance = true})
              .image.channel("irradiance.G")[0] == Approx(1.2f / std::sqrt(5.0f)).epsilon(0.005));
  }
}

}  // namespace voxref
