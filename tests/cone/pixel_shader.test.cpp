#include "cone/pixel_shader.h"

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "catch.h"
#include "cone/volumes.h"
#include "reference/small_scenes.h"
#include "settings.h"

// Each rule of the published shaders for a pixel, alone: one parameter is switched, in either profile where it applies.

using namespace voxref;

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr int side = 32;  // voxels, one world unit each

/// A closed box of glowing walls one voxel thick, in a grid of 32 voxels; beyond x = 22 they glow twice as much.
Pyramid8 glowing_box() {
  static const Pyramid8 pyramid = [] {
    BrickVolume<Rgba8> base{glm::ivec3(side)};
    std::vector<glm::ivec3> bricks;
    for (int i = 0; i < 64; ++i) bricks.emplace_back(i % 4, i / 4 % 4, i / 16);
    base.allocate(bricks);
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          if (on_box({x, y, z}, glm::ivec3(side), 0))
            base({x, y, z}) = x < 22 ? Rgba8{{51, 102, 51, 255}} : Rgba8{{25, 204, 25, 255}};
    return mipmap(unit_grid(glm::ivec3(side)), std::move(base), MipmapOptions{});
  }();
  return pyramid;
}

/// Shades one point in a box of 32 units that glows, with one light.
class Stage {
 public:
  Settings settings = profile("villegas2016");
  GBufferPoint point;
  Scene scene;
  LitVolume volume = glowing_box();
  Bounds box;

  Stage() {
    add_floor(scene, 1.0f, add_material(scene, lambert(glm::vec3(0.5f))));
    Light light;
    light.position = {16.0f, 26.0f, 16.0f};
    light.intensity = glm::vec3(1.0f);
    scene.lights.push_back(light);
    box.min = glm::vec3(0.0f), box.max = glm::vec3(float(side));
    point.position = {16.0f, 6.0f, 16.0f};
    point.normal = point.geometric_normal = point.to_viewer = {0.0f, 1.0f, 0.0f};
    point.phong.diffuse = glm::vec3(0.5f);
    point.reflectance.diffuse = glm::vec3(0.5f);
    settings.render.pixel.shadow = PixelShadow::none;
  }
  PixelLight operator()() const {
    const Caster caster(scene);
    return PixelShader({scene, caster, volume, box, settings.light}, settings.render, glm::vec3(0.0f))(point);
  }
  RenderOptions& render() { return settings.render; }
};

}  // namespace

TEST_CASE("The exponent 2.2 on indirect light turns twice the light into 4.59 times the indirect", "[pixel_shader]") {
  Stage stage;
  stage.scene.lights.clear();
  const auto strong_to_weak = [&stage] {
    stage.render().composite.bounce_strength = 4.0f;
    const float twice = stage().color.g;
    stage.render().composite.bounce_strength = 2.0f;
    return twice / stage().color.g;
  };
  CHECK(strong_to_weak() == Approx(std::pow(2.0f, 2.2f)).epsilon(1e-5));
  CHECK(strong_to_weak() == Approx(4.59f).epsilon(2e-3));
  stage.render().composite.indirect_power = 1.0f;
  CHECK(strong_to_weak() == Approx(2.0f).epsilon(1e-5));
}

TEST_CASE("R,G,B is (direct + (strength (diffuse + specular))^power) ao + emission", "[pixel_shader]") {
  Stage stage;
  stage.point.phong.specular = glm::vec3(0.3f);
  stage.point.phong.glossiness = 0.5f;
  stage.point.emission = glm::vec3(0.25f);
  stage.render().ao.enabled = true;
  stage.render().ao.falloff = 1.0f;
  const PixelLight light = stage();
  CHECK(light.ao < 0.9f);
  CHECK(light.direct.g > 0.0f);
  CHECK(light.specular.g > 0.0f);
  const float indirect = std::pow(2.0f * (light.diffuse.g + light.specular.g), 2.2f);
  CHECK(light.color.g == Approx((light.direct.g + indirect) * light.ao + 0.25f).epsilon(1e-5));
}

TEST_CASE("Cones gather with the albedo as it is stored, direct light with its power 2.2", "[pixel_shader]") {
  Stage stage;
  const PixelLight half = stage();
  stage.point.phong.diffuse = glm::vec3(1.0f);
  const PixelLight white = stage();
  CHECK(half.diffuse.g == Approx(0.5f * white.diffuse.g).epsilon(1e-6));
  CHECK(half.direct.g == Approx(std::pow(0.5f, 2.2f) * white.direct.g).epsilon(1e-5));
}

TEST_CASE("Without 1/pi diffuse light is pi times as strong, gathered and direct", "[pixel_shader]") {
  Stage stage;
  const PixelLight published = stage();
  stage.render().pixel.phong.divide_by_pi = true;
  const PixelLight lambertian = stage();
  CHECK(published.diffuse.g == Approx(pi * lambertian.diffuse.g).epsilon(1e-5));
  CHECK(published.direct.g == Approx(pi * lambertian.direct.g).epsilon(1e-5));
}

TEST_CASE("Black surfaces gather nothing and count as open", "[pixel_shader]") {
  Stage stage;
  stage.point.phong.diffuse = glm::vec3(0.0f);
  stage.render().ao.enabled = true;
  stage.render().ao.falloff = 0.0f;
  CHECK(stage().ao == 1.0f);
  CHECK(stage().diffuse == glm::vec3(0.0f));
  stage.render().ao.skip_black = false;
  CHECK(stage().ao < 0.1f);  // a closed box
}

TEST_CASE("Occlusion is the cones' sum, which is pi in a closed box, or their mean", "[pixel_shader]") {
  Stage stage;
  stage.render().ao.enabled = true;
  stage.render().ao.falloff = 60.0f;  // so that there is something left
  const auto openness = [&](bool normalized, float alpha) {
    stage.render().ao.normalized = normalized;
    stage.render().ao.alpha = alpha;
    return stage().ao;
  };
  const float mean = openness(true, 0.0f), sum = openness(false, 0.0f);
  CHECK(mean > 0.0f);
  CHECK(1.0f - sum == Approx(pi * (1.0f - mean)).epsilon(1e-4));
  CHECK(openness(true, 0.1f) == Approx(std::min(mean + 0.1f, 1.0f)).epsilon(1e-5));
}

TEST_CASE("Tolerance 0 takes opacity as it is, more multiplies it by 2^(7 t), 1 blackens wherever there is some",
          "[pixel_shader]") {
  Stage stage;
  stage.render().pixel.shadow = PixelShadow::cone;
  // A plate of opacity 2/255, two voxels thick, between the point and the light.
  BrickVolume<Rgba8> base{glm::ivec3(side)};
  const std::array<glm::ivec3, 1> brick = {glm::ivec3(2, 2, 2)};
  base.allocate(brick);
  for (int i = 0; i < 8 * 2 * 8; ++i) base({16 + i % 8, 16 + i / 8 % 2, 16 + i / 16}) = Rgba8{{0, 0, 0, 2}};
  stage.point.position = {20.0f, 6.0f, 20.0f};
  stage.scene.lights[0].position = {20.0f, 26.0f, 20.0f};
  stage.volume = mipmap(unit_grid(glm::ivec3(side)), std::move(base), MipmapOptions{});
  stage.render().cone.raw_unit = 1.0f;
  stage.render().pixel.shadow_cone_aperture = 0.01f;
  const auto direct = [&](float tolerance) {
    stage.render().pixel.shadow_cone_tolerance = tolerance;
    return stage().direct.g;
  };
  const float soft = direct(0.0f);
  CHECK(soft > 0.0f);
  CHECK(direct(0.2f) < soft);
  CHECK(direct(0.2f) > 0.0f);
  CHECK(direct(1.0f) == 0.0f);
  stage.render().pixel.shadow = PixelShadow::none;
  CHECK(direct(1.0f) > soft);
}

TEST_CASE("A shadow cone's first sample lies two units from the surface: what is nearer casts none", "[pixel_shader]") {
  Stage stage;
  stage.render().pixel.shadow = PixelShadow::cone;
  // Samples at s = 4, 8, 16 after a start at x = 8, that is at x = 12, 16, 24; only the first reads the base.
  stage.render().pixel.shadow_cone_aperture = 0.5f;
  stage.render().cone.step = 1.0f;
  stage.render().pixel.shadow_cone_tolerance = 1.0f;
  stage.render().cone.raw_unit = 4.0f;
  stage.point.position = {4.0f, 4.0f, 16.0f};
  stage.scene.lights[0].position = {30.0f, 4.0f, 16.0f};
  stage.point.normal = stage.point.geometric_normal = {1.0f, 0.0f, 0.0f};
  const auto shadow_of_wall_at = [&](int x) {
    const BrickVolume<glm::vec4> base =
        fill(glm::ivec3(side), [&](const glm::ivec3& v) { return v.x == x ? glm::vec4(1.0f) : glm::vec4(0.0f); });
    Pyramid pyramid = mipmap(unit_grid(glm::ivec3(side)), BrickVolume<glm::vec4>(base), MipmapOptions{});
    for (auto& level : pyramid.levels) level = std::decay_t<decltype(level)>(level.size());  // the base alone
    stage.volume = std::move(pyramid);
    return stage().direct.g == 0.0f;
  };
  CHECK_FALSE(shadow_of_wall_at(9));
  CHECK(shadow_of_wall_at(11));
  CHECK(shadow_of_wall_at(12));
  CHECK_FALSE(shadow_of_wall_at(13));
}

TEST_CASE("A ray that misses the scene's box gathers nothing and is in shadow; unless that test is off",
          "[pixel_shader]") {
  Stage stage;
  stage.render().pixel.shadow = PixelShadow::cone;
  stage.volume = mipmap(unit_grid(glm::ivec3(side)), BrickVolume<glm::vec4>(glm::ivec3(side)), MipmapOptions{});
  CHECK(stage().direct.g > 0.0f);
  stage.box.max.y = 6.0f;  // the point lies on the box's upper face and looks out of it
  CHECK(stage().direct.g == 0.0f);
  stage.render().cone.box_test = false;
  CHECK(stage().direct.g > 0.0f);

  stage.volume = glowing_box();
  stage.render().pixel.shadow = PixelShadow::none;
  CHECK(stage().diffuse.g > 0.0f);
  stage.render().cone.box_test = true;
  CHECK(stage().diffuse.g == 0.0f);
}

TEST_CASE("Cones end at the maximal distance", "[pixel_shader]") {
  Stage stage;
  const float all = stage().diffuse.g;
  stage.render().cone.max_distance = 0.1f;  // 3.2 units: 6 from the floor, further from the other walls
  CHECK(stage().diffuse.g < 0.3f * all);
}

TEST_CASE("The specular cone's width comes from the lobe or from glossiness, in either profile", "[pixel_shader]") {
  for (const char* name : {"radiometric", "villegas2016"}) {
    Stage stage;
    stage.settings = profile(name);
    if (stage.render().cone.opacity == ConeOpacity::extinction) stage.volume = make_medium(Pyramid8(glowing_box()));
    stage.render().pixel.shadow = PixelShadow::none;
    stage.point.normal = stage.point.geometric_normal = glm::normalize(glm::vec3(0.3f, 1.0f, 0.0f));
    stage.point.phong.specular = stage.point.reflectance.specular_f0 = glm::vec3(0.5f);
    stage.point.phong.glossiness = 0.0f;
    stage.point.reflectance.alpha = 0.01f;
    stage.render().pixel.specular_cone = SpecularCone::ggx;
    const float narrow = stage().specular.g;
    stage.render().pixel.specular_cone = SpecularCone::glossiness;
    CHECK(std::abs(stage().specular.g - narrow) > 0.01f * narrow);  // a few voxels more of the brighter wall
    stage.point.phong.glossiness = 1.0f;
    CHECK(stage().specular.g == Approx(narrow).epsilon(0.05));  // both about a degree wide
  }
}

TEST_CASE("Light that arrives from behind the geometric surface counts only where there is none", "[pixel_shader]") {
  Stage stage;
  stage.point.normal = glm::normalize(glm::vec3(1.0f, 0.2f, 0.0f));
  stage.point.geometric_normal = stage.point.normal;  // as gbuffer.geometric_normal=false leaves it
  stage.scene.lights[0].position = {26.0f, 5.0f, 16.0f};
  CHECK(stage().direct.g > 0.0f);
  stage.point.geometric_normal = {0.0f, 1.0f, 0.0f};
  CHECK(stage().direct.g == 0.0f);
}

TEST_CASE("Either BRDF works with either march and either storage", "[pixel_shader]") {
  for (const PixelBrdf brdf : {PixelBrdf::ggx, PixelBrdf::blinn_phong}) {
    Stage stage;
    stage.render().pixel.brdf = brdf;
    const float raw = stage().diffuse.g;
    CHECK(raw > 0.0f);
    stage.volume = make_medium(Pyramid8(glowing_box()));
    stage.render().cone.opacity = ConeOpacity::extinction;
    CHECK(stage().diffuse.g > 0.5f * raw);
    CHECK(stage().diffuse.g < 1.5f * raw);
  }
}

TEST_CASE("The visibility volume is read between voxels", "[pixel_shader]") {
  Stage stage;
  stage.render().pixel.shadow = PixelShadow::visibility;
  SurfaceGrid surfaces;
  surfaces.grid = unit_grid(glm::ivec3(side));
  surfaces.voxels = {{15, 5, 15}, {16, 5, 15}};
  const std::array<float, 2> shares = {1.0f, 0.5f};
  const LightVisibility visibility(surfaces, shares);
  CHECK(visibility({15.5f, 5.5f, 15.5f}) == 1.0f);
  CHECK(visibility({16.0f, 5.5f, 15.5f}) == 0.75f);
  CHECK(visibility({16.0f, 6.0f, 16.0f}) == 0.75f / 4.0f);  // nothing is stored above and beside
  const Caster caster(stage.scene);
  const LitScene lit{stage.scene, caster, stage.volume, stage.box, stage.settings.light, &visibility};
  const float seen = PixelShader(lit, stage.settings.render, glm::vec3(0.0f))(stage.point).direct.g;
  stage.render().pixel.shadow = PixelShadow::none;
  CHECK(seen == Approx(0.75f / 4.0f * stage().direct.g).epsilon(1e-5));
}
