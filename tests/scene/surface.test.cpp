#include "scene/surface.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "catch.h"
#include "error.h"

using namespace voxref;

namespace {

/// One triangle in the plane z = 0, front towards +z, with the given material.
Scene one_triangle(const Material& material) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.normals.assign(3, {0.0f, 0.0f, 1.0f});
  scene.triangles = {{0, 1, 2}};
  scene.triangle_materials = {0};
  scene.objects = {{"triangle", 0, 1, 0, false}};
  scene.materials = {material};
  return scene;
}

Hit hit_at(float u, float v) { return {0, {u, v}, 1.0f}; }

MaterialPoint material_at(const Scene& scene, const glm::vec2& uv) { return Materials(scene).point(0, uv); }

const glm::vec3 above(0.0f, 0.0f, 1.0f);

}  // namespace

TEST_CASE("normals turn to the viewer's side; emission leaves the front only, unless double-sided", "[surface]") {
  Material lamp;
  lamp.emission = {1.0f, 2.0f, 3.0f};
  Scene scene = one_triangle(lamp);
  const SurfacePoint front = Surfaces(scene).point(hit_at(0.25f, 0.5f), above);
  CHECK(front.front);
  CHECK(front.position == glm::vec3(0.25f, 0.5f, 0.0f));
  CHECK(front.geometric_normal == above);
  CHECK(front.emission == lamp.emission);
  const SurfacePoint back = Surfaces(scene).point(hit_at(0.25f, 0.5f), -above);
  CHECK_FALSE(back.front);
  CHECK(back.geometric_normal == -above);
  CHECK(back.shading_normal == -above);
  CHECK(back.emission == glm::vec3(0.0f));
  scene.materials[0].double_sided = true;
  CHECK(Surfaces(scene).point(hit_at(0.25f, 0.5f), -above).emission == lamp.emission);
}

TEST_CASE("interpolated normals are unit and bent to face the viewer", "[surface]") {
  Scene scene = one_triangle({});
  scene.normals = {glm::normalize(glm::vec3(1, 0, 1)), {0, 0, 1}, glm::normalize(glm::vec3(-1, 0, 1))};
  CHECK(glm::length(Surfaces(scene).point(hit_at(0.2f, 0.7f), above).shading_normal) == Approx(1.0f));
  const glm::vec3 grazing = glm::normalize(glm::vec3(-1.0f, 0.0f, 0.1f));
  const SurfacePoint point = Surfaces(scene).point(hit_at(0.0f, 0.0f), grazing);
  CHECK(glm::dot(point.shading_normal, grazing) > 0.0f);
}

TEST_CASE("what is computed once over a flat, plain triangle is what interpolation and textures give", "[surface]") {
  Material plain;
  plain.base_color = {0.8f, 0.4f, 0.2f, 1.0f};
  plain.emission = {1.0f, 2.0f, 3.0f};
  const Scene scene = one_triangle(plain);
  REQUIRE(Materials(scene).constant(0));
  Scene textured = one_triangle(plain);  // with a white texel, and normals whose difference is below what float shows
  textured.uv[0].assign(3, glm::vec2(0.5f));
  textured.images.resize(1);
  textured.images[0].width = textured.images[0].height = 1;
  textured.images[0].texels8 = {255, 255, 255, 255};
  textured.materials[0].base_color_texture.image = 0;
  textured.normals[1].x = 1e-20f;
  REQUIRE_FALSE(Materials(textured).constant(0));
  const glm::vec3 oblique = glm::normalize(glm::vec3(1.0f, -0.5f, 0.3f));
  for (const glm::vec3& viewer : {oblique, -oblique}) {
    const SurfacePoint once = Surfaces(scene).point(hit_at(0.2f, 0.7f), viewer);
    const SurfacePoint each = Surfaces(textured).point(hit_at(0.2f, 0.7f), viewer);
    CHECK(once.position == each.position);
    CHECK(once.geometric_normal == each.geometric_normal);
    // Interpolating three equal normals rounds twice before it is made unit again.
    CHECK(glm::distance(once.shading_normal, each.shading_normal) < 3e-7f);
    CHECK(once.emission == each.emission);
    CHECK(once.reflectance.diffuse == each.reflectance.diffuse);
    CHECK(once.reflectance.specular_f0 == each.reflectance.specular_f0);
  }
}

TEST_CASE("metallic-roughness comes out as glTF's appendix B says", "[surface]") {
  Material m;
  m.base_color = {0.8f, 0.4f, 0.2f, 1.0f};
  m.roughness = 0.5f;
  SECTION("a dielectric keeps a 4 % lobe over its diffuse base") {
    m.metallic = 0.0f;
    const Reflectance r = material_at(one_triangle(m), {0.3f, 0.3f}).reflectance;
    CHECK(r.diffuse == glm::vec3(m.base_color));
    CHECK(r.specular_f0.g == Approx(0.04f));
    CHECK(r.specular_f1.g == Approx(0.96f));
    CHECK(r.layer_f0 == Approx(0.04f));
    CHECK(r.alpha == Approx(0.25f));
  }
  SECTION("specularFactor 0 makes it Lambertian") {
    m.metallic = 0.0f;
    m.specular = 0.0f;
    const Reflectance r = material_at(one_triangle(m), {0.3f, 0.3f}).reflectance;
    CHECK_FALSE(r.has_specular());
    CHECK(r.layer_f0 == 0.0f);
    CHECK(r.layer_f1 == 0.0f);
  }
  SECTION("a metal has its base colour as F0 and no diffuse part") {
    const Reflectance r = material_at(one_triangle(m), {0.3f, 0.3f}).reflectance;
    CHECK_FALSE(r.has_diffuse());
    CHECK(r.specular_f0 == glm::vec3(m.base_color));
    CHECK(r.specular_f0 + r.specular_f1 == glm::vec3(1.0f));
  }
}

TEST_CASE("specular-glossiness takes the strongest F0 off its diffuse colour", "[surface]") {
  Material m;
  m.workflow = Workflow::specular_glossiness;
  m.base_color = {0.5f, 0.5f, 0.5f, 1.0f};
  m.specular_color = {0.2f, 0.6f, 0.4f};
  m.glossiness = 0.3f;
  const Reflectance r = material_at(one_triangle(m), {0.3f, 0.3f}).reflectance;
  CHECK(r.diffuse.r == Approx(0.5f * 0.4f));
  CHECK(r.specular_f0 == m.specular_color);
  CHECK(r.alpha == Approx(0.49f));
}

TEST_CASE("vertex colours multiply the base colour", "[surface]") {
  Scene scene = one_triangle({});
  scene.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  CHECK(material_at(scene, {0.25f, 0.25f}).base_color == glm::vec3(0.5f, 0.25f, 0.25f));
}

TEST_CASE("a normal map turns the shading normal within the tangent frame", "[surface]") {
  Material m;
  m.normal_texture.image = 0;
  Scene scene = one_triangle(m);
  scene.uv[0] = {{0, 0}, {1, 0}, {0, 1}};
  scene.images.resize(1);
  scene.images[0].width = scene.images[0].height = 1;
  // (1, 0.5, 0.5): the tangent itself; then (0.5, 1, 0.5): the bitangent.
  scene.images[0].texels16 = {65535, 32768, 32768, 65535};
  scene.tangents.assign(3, {0.0f, 1.0f, 0.0f, -1.0f});
  const glm::vec3 oblique = glm::normalize(glm::vec3(1.0f, 1.0f, 1.0f));
  CHECK(glm::distance(Surfaces(scene).point(hit_at(0.3f, 0.3f), oblique).shading_normal, glm::vec3(0, 1, 0)) < 1e-4f);
  scene.images[0].texels16 = {32768, 65535, 32768, 65535};
  // w cross(n, t) = -cross(z, y) = x
  CHECK(glm::distance(Surfaces(scene).point(hit_at(0.3f, 0.3f), oblique).shading_normal, glm::vec3(1, 0, 0)) < 1e-4f);
}

TEST_CASE("a mask's coverage is alpha against the cutoff", "[surface]") {
  Material m;
  m.alpha_mode = AlphaMode::mask;
  m.alpha_cutoff = 0.5f;
  m.base_color.a = 0.49f;
  CHECK_FALSE(covered(one_triangle(m), 0, {0.3f, 0.3f}));
  CHECK(material_at(one_triangle(m), {0.3f, 0.3f}).opacity == 0.0f);
  m.base_color.a = 0.5f;
  CHECK(covered(one_triangle(m), 0, {0.3f, 0.3f}));
  m.alpha_mode = AlphaMode::opaque;
  m.base_color.a = 0.0f;
  CHECK(covered(one_triangle(m), 0, {0.3f, 0.3f}));
}

TEST_CASE("a scene that later stages could not rely on is refused with its place", "[scene]") {
  const Scene good = one_triangle({});
  CHECK_NOTHROW(validate(good));
  SECTION("index beyond the vertices") {
    Scene bad = good;
    bad.triangles[0].z = 3;
    CHECK_THROWS_AS(validate(bad), Error);
  }
  SECTION("position that is not a number") {
    Scene bad = good;
    bad.positions[1].y = NAN;
    CHECK_THROWS_AS(validate(bad), Error);
  }
  SECTION("objects that do not cover the triangles") {
    Scene bad = good;
    bad.objects.clear();
    CHECK_THROWS_AS(validate(bad), Error);
    bad.objects = {{"triangle", 0, 2, 0, false}};
    CHECK_THROWS_AS(validate(bad), Error);
  }
  SECTION("texture that is not there") {
    Scene bad = good;
    bad.materials[0].normal_texture.image = 0;
    CHECK_THROWS_AS(validate(bad), Error);
  }
}
