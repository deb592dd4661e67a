#include "cone/gbuffer.h"

#include <glm/geometric.hpp>

#include "catch.h"
#include "error.h"
#include "reference/small_scenes.h"

using namespace voxref;

namespace {

/// What the middle of the image shows.
std::optional<GBufferPoint> seen(const Scene& scene, const GBufferOptions& options, const glm::vec3& eye,
                                 float zfar = 100.0f) {
  const Caster caster(scene);
  View view = view_from(eye, glm::vec3(0.0f), 1, 1);
  view.camera.znear = 0.1f;
  view.camera.zfar = zfar;
  return GBuffer(scene, caster, view, options)(glm::vec2(0.5f));
}

Material masked(float alpha) {
  Material material = lambert(glm::vec3(0.5f));
  material.base_color.a = alpha;
  material.alpha_mode = AlphaMode::mask;
  return material;
}

/// A floor at y = 0 over another at y = -1.
Scene two_floors(const Material& upper) {
  Scene scene;
  add_floor(scene, 1.0f, add_material(scene, upper));
  add_quad(scene, {-1.0f, -1.0f, -1.0f}, {0.0f, 0.0f, 2.0f}, {2.0f, 0.0f, 0.0f},
           add_material(scene, lambert(glm::vec3(0.25f))));
  return scene;
}

const glm::vec3 above(0.0f, 3.0f, 0.0f), below(0.0f, -3.0f, 0.0f);

}  // namespace

TEST_CASE("Back faces are seen, or culled whatever doubleSided says", "[gbuffer]") {
  Material material = lambert(glm::vec3(0.5f));
  material.double_sided = true;
  const Scene scene = two_floors(material);
  GBufferOptions options;
  CHECK(seen(scene, options, below)->depth == Approx(2.0f));
  options.cull_back_faces = true;
  CHECK_FALSE(seen(scene, options, below).has_value());
  CHECK(seen(scene, options, above)->depth == Approx(3.0f));

  Scene turned = two_floors(material);  // the upper one faces down
  for (size_t i = 0; i < 2; ++i) std::swap(turned.triangles[i].y, turned.triangles[i].z);
  CHECK(seen(turned, options, above)->depth == Approx(4.0f));
}

TEST_CASE("Surfaces of little alpha are discarded at a fixed limit instead of the material's own", "[gbuffer]") {
  GBufferOptions own, published;
  published.discard_alpha = 0.01f;
  const float upper = 3.0f, lower = 4.0f;
  CHECK(seen(two_floors(masked(0.3f)), own, above)->depth == Approx(lower));
  CHECK(seen(two_floors(masked(0.3f)), published, above)->depth == Approx(upper));
  CHECK(seen(two_floors(masked(0.01f)), published, above)->depth == Approx(lower));
  CHECK(seen(two_floors(masked(0.011f)), published, above)->depth == Approx(upper));
  Material opaque = masked(0.0f);  // the shaders know no alpha modes
  opaque.alpha_mode = AlphaMode::opaque;
  CHECK(seen(two_floors(opaque), own, above)->depth == Approx(upper));
  CHECK(seen(two_floors(opaque), published, above)->depth == Approx(lower));
}

TEST_CASE("Half-float normals are cut off, not rounded, and made unit again", "[gbuffer]") {
  Scene scene = two_floors(lambert(glm::vec3(0.5f)));
  const glm::vec3 n = glm::normalize(glm::vec3(0.3f, 1.0f, -1e-5f));
  for (glm::vec3& normal : scene.normals) normal = n;
  GBufferOptions options;
  CHECK(glm::distance(seen(scene, options, above)->normal, n) < 1e-6f);
  options.normal = NormalFormat::float16;
  // x = 0.28735 lies between the halves 588 and 589 / 2048, y = 0.95783 between 1961 and 1962 / 2048; z is below the
  // least normal half, 2^-14, and has steps of 2^-24.
  const glm::vec3 cut(588.0f / 2048.0f, 1961.0f / 2048.0f, -std::trunc(-n.z * 0x1p24f) * 0x1p-24f);
  CHECK(glm::distance(seen(scene, options, above)->normal, glm::normalize(cut)) < 1e-7f);
}

TEST_CASE("Colours in bytes round to the nearest and clamp to 1", "[gbuffer]") {
  Material material = lambert({0.1f, 0.7f, 1.0f}, {3.0f, 0.5f, 0.0f});
  GBufferOptions options;
  CHECK(seen(two_floors(material), options, above)->emission.r == 3.0f);
  options.color = ColorFormat::unorm8;
  const auto point = seen(two_floors(material), options, above);
  constexpr float byte = 1.0f / 255.0f;
  CHECK(point->emission == glm::vec3(255.0f * byte, 128.0f * byte, 0.0f));               // 127.5 to even
  CHECK(point->phong.diffuse == glm::vec3(26.0f * byte, 178.0f * byte, 255.0f * byte));  // 25.5 and 178.5 to even
  CHECK(point->reflectance.diffuse == point->phong.diffuse);
}

TEST_CASE("Glossiness is 0.01 at least", "[gbuffer]") {
  Material rough = lambert(glm::vec3(0.5f));
  rough.workflow = Workflow::specular_glossiness;
  GBufferOptions options;
  rough.glossiness = 0.0f;
  CHECK(seen(two_floors(rough), options, above)->phong.glossiness == 0.01f);
  options.color = ColorFormat::unorm8;
  CHECK(seen(two_floors(rough), options, above)->phong.glossiness == Approx(3.0f / 255.0f));  // 2.55
  rough.glossiness = 0.5f;
  options.color = ColorFormat::float32;
  CHECK(seen(two_floors(rough), options, above)->phong.glossiness == 0.5f);
}

TEST_CASE("A depth of 24 bits moves the position by less than a step, and cuts off at the planes", "[gbuffer]") {
  const Scene scene = two_floors(lambert(glm::vec3(0.5f)));
  GBufferOptions options;
  options.depth = DepthFormat::unorm24;
  // dz = 2^-24 z^2 / n x (1 - n / f): 5.4e-6 here; half of it, and float32's rounding.
  const auto point = seen(scene, options, above);
  CHECK(std::abs(point->position.y) < 2.7e-6f + 1e-6f);
  CHECK(seen(scene, options, above, 2.9f) == std::nullopt);
  const auto unbounded = seen(scene, options, above, std::numeric_limits<float>::infinity());
  CHECK(std::abs(unbounded->position.y) < 2.7e-6f + 1e-6f);
  CHECK_THROWS_AS(seen(scene, options, above, 0.05f), Error);  // behind the near plane

  const Caster caster(scene);
  View view = view_from(above, glm::vec3(0.0f), 1, 1);
  view.camera.orthographic = true;
  view.camera.znear = 0.0f, view.camera.zfar = 4.0f;
  CHECK(GBuffer(scene, caster, view, options)(glm::vec2(0.5f))->depth == Approx(3.0f).epsilon(1e-6));
}

TEST_CASE("Without a geometric normal shading normals are taken as they are, away from the viewer too", "[gbuffer]") {
  Scene scene = two_floors(lambert(glm::vec3(0.5f)));
  const glm::vec3 away = glm::normalize(glm::vec3(1.0f, -0.2f, 0.0f));
  for (glm::vec3& normal : scene.normals) normal = away;
  GBufferOptions options;
  CHECK(seen(scene, options, above)->normal.y > 0.0f);  // bent towards the viewer
  CHECK(seen(scene, options, above)->geometric_normal.y == 1.0f);
  options.geometric_normal = false;
  CHECK(glm::distance(seen(scene, options, above)->normal, away) < 1e-6f);
  CHECK(seen(scene, options, above)->geometric_normal == seen(scene, options, above)->normal);
}

TEST_CASE("Textures are decoded, or taken as the file holds them", "[gbuffer]") {
  Scene scene = two_floors(lambert(glm::vec3(1.0f)));
  TextureImage grey;
  grey.width = grey.height = 1;
  grey.texels8 = {128, 128, 128, 255};
  scene.images.push_back(grey);
  scene.uv[0].assign(scene.positions.size(), glm::vec2(0.5f));
  scene.materials[0].base_color_texture.image = 0;
  scene.materials[0].base_color_texture.srgb = true;
  scene.materials[0].emission = glm::vec3(1.0f);
  GBufferOptions options;
  CHECK(seen(scene, options, above)->emission.g == 1.0f);
  CHECK(seen(scene, options, above)->phong.diffuse.g == Approx(0.21586f).epsilon(1e-4));  // IEC 61966-2-1
  options.decode_textures = false;
  CHECK(seen(scene, options, above)->phong.diffuse.g == Approx(128.0f / 255.0f).epsilon(1e-6));
  CHECK(seen(scene, options, above)->emission.g == Approx(128.0f / 255.0f).epsilon(1e-6));  // the base colour's texel
}
