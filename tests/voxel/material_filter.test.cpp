#include "voxel/material_filter.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "catch.h"
#include "voxel/mesh_scene.h"
#include "voxel/voxelize.h"

using namespace voxref;

namespace {

/// A square of 8 x 8 voxels at height 2.5 whose texture covers it once. @param texel rgba bytes of column x, row y
template <class Texel>
Scene textured_square(int width, int height, Texel&& texel, bool srgb = false) {
  Scene scene = scene_of(quad({1, 2.5f, 1}, {1, 2.5f, 9}, {9, 2.5f, 9}, {9, 2.5f, 1}), lambertian("", glm::vec3(1)));
  scene.uv[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  TextureImage image;
  image.width = width;
  image.height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int byte : texel(x, y)) image.texels8.push_back(uint8_t(byte));
  scene.images = {image};
  TextureBinding& binding = scene.materials[0].base_color_texture;
  binding.image = 0;
  binding.srgb = srgb;
  binding.nearest = true;
  return scene;
}

using Texel = std::array<int, 4>;
const Grid grid = unit_grid({10, 5, 10});

glm::dvec3 mean_albedo(const SurfaceGrid& surfaces) {
  glm::dvec3 sum(0.0);
  double area = 0.0;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    sum += double(surfaces.area[i]) * glm::dvec3(surfaces.albedo[i]);
    area += surfaces.area[i];
  }
  return sum / area;
}

}  // namespace

TEST_CASE("a texture is averaged over each voxel, in linear light", "[material_filter]") {
  // 8 x 8 texels per voxel: a checkerboard of black and a colour that changes from voxel to voxel.
  const auto code = [](int voxel) { return 30 + 32 * voxel; };
  const auto decoded = [](int byte) { return std::pow((float(byte) / 255.0f + 0.055f) / 1.055f, 2.4f); };
  const Scene scene = textured_square(
      64, 64,
      [&](int x, int y) {
        return (x + y) % 2 ? Texel{0, 0, 0, 255} : Texel{code(x / 8), 255, code(y / 8), 255};
      },
      true);
  const SurfaceGrid surfaces = voxelize(scene, grid, {});
  REQUIRE(surfaces.size() == 64);
  glm::dvec3 expected_mean(0.0);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const glm::ivec3 v = surfaces.voxels[i] - 1;
    const glm::vec3 expected = 0.5f * glm::vec3(decoded(code(v.x)), 1.0f, decoded(code(v.z)));
    expected_mean += glm::dvec3(expected) / 64.0;
    // 64 points that know nothing of the texels: one standard deviation of a fair coin thrown so often is 1/16, even
    // spreading makes it less.
    CHECK(std::abs(surfaces.albedo[i].g - 0.5f) < 0.1f);
    CHECK(std::abs(surfaces.albedo[i].r - expected.r) < 0.1f);
    CHECK(std::abs(surfaces.albedo[i].b - expected.b) < 0.1f);
  }
  // Over all voxels 8 times closer.
  CHECK(glm::length(mean_albedo(surfaces) - expected_mean) < 0.1 / 8.0);
}

TEST_CASE("a texture of one colour is exact, whatever its size", "[material_filter]") {
  for (const int side : {1, 3, 256}) {
    const Scene scene = textured_square(side, side, [](int, int) { return Texel{51, 102, 255, 255}; });
    for (const glm::vec4& albedo : voxelize(scene, grid, {}).albedo)
      CHECK(glm::length(albedo - glm::vec4(0.2f, 0.4f, 1.0f, 1.0f)) < 1e-6f);  // sums of 64 doubles of float32 values
  }
}

TEST_CASE("vertex colours have their mean at the centroid", "[material_filter]") {
  Scene scene = textured_square(1, 1, [](int, int) { return Texel{255, 255, 255, 255}; });
  scene.materials[0].base_color_texture = {};
  scene.colors = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 1, 1}, {1, 0, 0, 1}};  // red along x, blue along z
  const SurfaceGrid surfaces = voxelize(scene, grid, {});
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const glm::vec3 expected = (surfaces.centroid[i] - 1.0f) / 8.0f * glm::vec3(1, 0, 1);
    CHECK(glm::length(glm::vec3(surfaces.albedo[i]) - expected) < 1e-6f);
  }
}

TEST_CASE("holes of an alpha mask have no area and no colour", "[material_filter]") {
  const auto masked = [](auto&& texel) {
    Scene scene = textured_square(64, 64, texel);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    return voxelize(scene, grid, {});
  };
  // Green holes in red.
  const SurfaceGrid stripes = masked([](int x, int) { return x % 2 ? Texel{255, 0, 0, 255} : Texel{0, 255, 0, 0}; });
  CHECK(stripes.size() == 64);
  double area = 0.0;
  for (size_t i = 0; i < stripes.size(); ++i) {
    CHECK(stripes.albedo[i] == glm::vec4(1, 0, 0, 1));
    area += stripes.area[i];
  }
  CHECK(area == Approx(32.0).epsilon(0.05));  // 4096 points: a standard deviation of 1/64 at the worst, three of them
  const SurfaceGrid left = masked([](int x, int) { return Texel{255, 0, 0, x < 32 ? 255 : 0}; });
  CHECK(left.size() == 32);
  for (const glm::ivec3& v : left.voxels) CHECK(v.x < 5);
  CHECK(masked([](int, int) { return Texel{255, 0, 0, 0}; }).size() == 0);
}

TEST_CASE("without a mask alpha is ignored", "[material_filter]") {
  CHECK(voxelize(textured_square(4, 4, [](int, int) { return Texel{255, 0, 0, 0}; }), grid, {}).size() == 64);
}

TEST_CASE("textured emission is averaged too", "[material_filter]") {
  Scene scene = textured_square(16, 16, [](int x, int) {
    return x % 2 ? Texel{255, 255, 255, 255} : Texel{0, 0, 0, 255};
  });
  scene.materials[0].emission = glm::vec3(4, 2, 0);
  std::swap(scene.materials[0].emission_texture, scene.materials[0].base_color_texture);
  const SurfaceGrid surfaces = voxelize(scene, grid, {});
  // Two by two texels, two triangles in some: four points or so per voxel, split evenly to about one of them.
  for (const glm::vec3& emission : surfaces.emission) {
    CHECK(std::abs(emission.r - 2.0f) <= 1.0f + 1e-6f);
    CHECK(emission.r == Approx(2.0f * emission.g));
  }
}

TEST_CASE("a voxel scatters what the material does, diffuse and specular, as albedo", "[material_filter]") {
  const auto albedo_of = [](const Material& material) {
    return glm::vec3(
        voxelize(scene_of(quad({1, 2.5f, 1}, {1, 2.5f, 9}, {9, 2.5f, 9}, {9, 2.5f, 1}), material), grid, {}).albedo[0]);
  };
  Material material;
  material.base_color = {0.5f, 0.25f, 1.0f, 1.0f};
  material.roughness = 0.3f;
  material.metallic = 1.0f;
  const glm::vec3 metal = albedo_of(material);
  // A smooth metal reflects little more than F0: Schlick adds (1 - F0)/21 over the hemisphere, roughness takes some.
  CHECK(std::abs(metal.r - (0.5f + 0.5f / 21.0f)) < 0.03f);
  CHECK(std::abs(metal.g - (0.25f + 0.75f / 21.0f)) < 0.03f);
  CHECK(metal.b <= 1.0f);
  material.metallic = 0.0f;
  const glm::vec3 plastic = albedo_of(material);
  material.specular = 0.0f;
  const glm::vec3 matte = albedo_of(material);
  CHECK(matte == glm::vec3(0.5f, 0.25f, 1.0f));
  CHECK(plastic.g > matte.g);   // a dark base gains from the lobe more than the layer takes from it ...
  CHECK(plastic.b <= matte.b);  // ... and a white one cannot scatter more than there is
  CHECK(plastic.b > 0.9f);
}
