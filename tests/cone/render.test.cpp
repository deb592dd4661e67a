#include "cone/render.h"

#include <glm/geometric.hpp>
#include <numbers>

#include "catch.h"
#include "cone/bounce.h"
#include "parallel.h"
#include "reference/small_scenes.h"
#include "scene/surface.h"
#include "voxel/shade.h"

using namespace voxref;

namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// The medium that the pipeline would march for a scene.
Medium medium_of(const Scene& scene, const Caster& caster, int resolution,
                 const glm::vec3& background = glm::vec3(0.0f)) {
  const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), {resolution}), {});
  const std::vector<glm::vec3> direct = shade(scene, &caster, surfaces, {}, {}).radiance;
  return make_medium(bounce(surfaces, direct, {}, {}, {}, background).pyramid);
}

ConeImage render(const Scene& scene, const View& view, const RenderOptions& options = {}, int resolution = 32) {
  const Caster caster(scene);
  const LitVolume volume = medium_of(scene, caster, resolution, view.background);
  return render_cones({scene, caster, volume, scene.bounds(), {}}, view, options);
}

Scene floor_and_lamp(const Material& material) {
  Scene scene;
  add_floor(scene, 1.0f, add_material(scene, material));
  Light light;
  light.position = {0.3f, 0.8f, -0.2f};
  light.intensity = {1.0f, 2.0f, 3.0f};
  scene.lights.push_back(light);
  return scene;
}

View from_above(int size) { return view_from({0.0f, 2.0f, 0.0f}, glm::vec3(0.0f), size, size); }

bool same_pixels(const Image& a, const Image& b) {
  bool same = a.channels() == b.channels();
  for (const std::string& channel : a.channels()) {
    const auto x = a.channel(channel), y = b.channel(channel);
    same = same && std::equal(x.begin(), x.end(), y.begin(), y.end());
  }
  return same;
}

}  // namespace

TEST_CASE("A closed furnace of emission 1 and albedo 1/2 shows 2 everywhere", "[cone_render]") {
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert(glm::vec3(0.5f), glm::vec3(1.0f))));
  const ConeImage seen = render(scene, view_from({0.1f, -0.2f, 0.3f}, {1.0f, 0.2f, 0.5f}, 24, 24, 1.5f));
  const Image& image = seen.image;
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    // Each gather returns 0.98 to 1 of the truth: 1 / (1 - 0.49) = 1.96; automatic bounces leave out 1 % more.
    CHECK(image.channel("R")[i] <= 2.0001f);
    CHECK(image.channel("R")[i] >= 1.94f);
    CHECK(image.channel("emission.R")[i] == 1.0f);
    CHECK(image.channel("direct.R")[i] == 0.0f);
    CHECK(image.channel("specular.R")[i] == 0.0f);
  }
  CHECK(seen.nonfinite == 0);
  CHECK(seen.first_nonfinite.empty());
}

TEST_CASE("Direct light of a point light over a plane is albedo / pi I cos / d^2, in the light and in its shadow",
          "[cone_render]") {
  Scene scene = floor_and_lamp(lambert({0.2f, 0.4f, 0.8f}));
  const uint32_t black = add_material(scene, lambert(glm::vec3(0.0f)));
  add_quad(scene, {0.2f, 0.4f, -0.1f}, {0.3f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.3f}, black);
  View view = from_above(32);
  for (const PixelShadow shadow : {PixelShadow::none, PixelShadow::rays}) {
    RenderOptions options;
    options.pixel.shadow = shadow;
    const Image image = render(scene, view, options).image;
    const RayGenerator rays(view);
    const Caster caster(scene);
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const Ray ray = rays(glm::vec2(x, y) + 0.5f);
        const Hit hit = caster.closest(ray);
        if (!hit || hit.triangle >= 2) continue;
        const glm::vec3 p = ray.origin + hit.t * ray.direction, to_light = scene.lights[0].position - p;
        const float d = glm::length(to_light);
        // Where the segment to the light crosses the plane of the blocker, y = 0.4.
        const glm::vec3 crossing = p + to_light * (0.4f / to_light.y);
        const glm::vec2 inside = glm::abs(glm::vec2(crossing.x - 0.35f, crossing.z - 0.05f));
        if (std::abs(std::max(inside.x, inside.y) - 0.15f) < 1e-3f) continue;  // on the shadow's very edge
        const bool dark = shadow == PixelShadow::rays && std::max(inside.x, inside.y) < 0.15f;
        const glm::vec3 truth =
            dark ? glm::vec3(0.0f)
                 : glm::vec3(0.2f, 0.4f, 0.8f) / pi * scene.lights[0].intensity * to_light.y / (d * d * d);
        const size_t i = size_t(y * view.width + x);
        for (int c = 0; c < 3; ++c) CHECK(image.layer("direct")[size_t(c)][i] == Approx(truth[c]).epsilon(1e-4));
      }
  }
}

TEST_CASE("A shadow cone agrees with shadow rays away from the edges", "[cone_render]") {
  Scene scene = floor_and_lamp(lambert(glm::vec3(0.5f)));
  add_quad(scene, {-0.4f, 0.4f, -0.6f}, {0.0f, 0.0f, 0.8f}, {0.8f, 0.0f, 0.0f},
           add_material(scene, lambert(glm::vec3(0.0f))));
  const View view = from_above(32);
  RenderOptions options;
  options.pixel.shadow_cone_aperture = 0.01f;
  const Image rays = render(scene, view, options, 128).image;
  options.pixel.shadow = PixelShadow::cone;
  const Image cones = render(scene, view, options, 128).image;
  int different = 0;
  for (size_t i = 0; i < rays.pixel_count(); ++i)
    different += std::abs(rays.channel("direct.R")[i] - cones.channel("direct.R")[i]) > 0.01f;
  CHECK(different <
        0.12 * double(rays.pixel_count()));  // the edge of the shadow, a voxel and a half wide, and the start's gap
}

TEST_CASE("A dielectric floor under a constant sky sends back what its directional albedos say", "[cone_render]") {
  Material material;
  material.base_color = {0.8f, 0.5f, 0.2f, 1.0f};
  material.metallic = 0.0f;
  material.roughness = 0.5f;
  Scene scene;
  add_floor(scene, 1.0f, add_material(scene, material));
  View view = view_from({0.0f, 1.0f, 2.0f}, glm::vec3(0.0f), 8, 8, 0.2f);
  view.background = glm::vec3(1.0f, 2.0f, 4.0f);
  const Image image = render(scene, view).image;
  const RayGenerator rays(view);
  const Caster caster(scene);
  const Surfaces surfaces(scene);
  for (int i = 0; i < 64; ++i) {
    const Ray ray = rays({float(i % 8) + 0.5f, float(i / 8) + 0.5f});
    const Hit hit = caster.closest(ray);
    REQUIRE(hit);
    const SurfacePoint point = surfaces.point(hit, -ray.direction);
    const float n_v = -ray.direction.y;
    const glm::vec3 truth =
        (diffuse_albedo(point.reflectance, n_v) + specular_albedo(point.reflectance, n_v)) * view.background;
    // Nothing but the floor, whose own voxels must not be seen: weights in float remain.
    for (int c = 0; c < 3; ++c) CHECK(image.layer("")[size_t(c)][size_t(i)] == Approx(truth[c]).epsilon(1e-4));
  }
}

TEST_CASE("Where nothing is hit there is the background, and a scene without triangles is all background",
          "[cone_render]") {
  View view = from_above(5);
  view.width = 7;
  view.background = {0.25f, 1.0f, 3.0f};
  const Image image = render(Scene{}, view).image;
  CHECK(image.width() == 7);
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    CHECK(image.channel("R")[i] == 0.25f);
    CHECK(image.channel("emission.B")[i] == 3.0f);
    CHECK(image.channel("Z")[i] == 0.0f);
    CHECK(image.channel("ao.Y")[i] == 1.0f);
  }
}

TEST_CASE("R,G,B is the sum of the layers, darkened by occlusion when that is asked for", "[cone_render]") {
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert({0.7f, 0.5f, 0.3f}, {0.1f, 0.2f, 0.3f})));
  scene.lights.push_back(Light{});
  const View view = view_from({0.1f, -0.2f, 0.3f}, {1.0f, 0.2f, 0.5f}, 16, 16, 1.5f);
  for (const bool enabled : {false, true}) {
    RenderOptions options;
    options.ao.enabled = enabled;
    const Image image = render(scene, view, options).image;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      const float ao = image.channel("ao.Y")[i];
      CHECK((enabled ? ao < 1.0f && ao > 0.0f : ao == 1.0f));
      const float sum =
          (image.channel("direct.G")[i] + image.channel("diffuse.G")[i] + image.channel("specular.G")[i]) * ao +
          image.channel("emission.G")[i];
      CHECK(image.channel("G")[i] == Approx(sum).epsilon(1e-6));
    }
  }
}

TEST_CASE("Box sampling takes the pixel's mean: half the floor, half the sky", "[cone_render]") {
  Scene scene;
  add_quad(scene, {-4.0f, 0.0f, -4.0f}, {0.0f, 0.0f, 8.0f}, {4.0f, 0.0f, 0.0f},
           add_material(scene, lambert({0.6f, 0.6f, 0.6f})));
  View view = from_above(1);
  view.pixel = PixelSampling::box;
  view.background = glm::vec3(1.0f);
  const Image image = render(scene, view).image;
  CHECK(image.channel("emission.R")[0] == Approx(0.5f).epsilon(1e-6));
  CHECK(image.channel("diffuse.R")[0] == Approx(0.3f).epsilon(1e-3));
  CHECK(image.channel("albedo.R")[0] == Approx(0.6f).epsilon(1e-6));
  CHECK(image.channel("N.Y")[0] == Approx(1.0f).epsilon(1e-6));
  CHECK(image.channel("Z")[0] == Approx(2.0f).epsilon(1e-6));
}

TEST_CASE("One thread and two render the same image, to the bit", "[cone_render]") {
  Scene scene = floor_and_lamp(Material{});
  add_quad(scene, {-0.4f, 0.4f, -0.6f}, {0.0f, 0.0f, 0.8f}, {0.8f, 0.0f, 0.0f}, 0);
  View view = from_above(40);
  view.background = glm::vec3(0.5f);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return render(scene, view).image;
  };
  CHECK(same_pixels(run(1), run(2)));
}

TEST_CASE("Pixels that are not finite are counted and left as they are", "[cone_render]") {
  View view = from_above(4);
  view.background.g = std::numeric_limits<float>::quiet_NaN();
  const ConeImage seen = render(Scene{}, view);
  CHECK(seen.nonfinite == 16);
  CHECK(seen.first_nonfinite == "pixel (0, 0)");
  CHECK(std::isnan(seen.image.channel("G")[3]));
}
