#include "cone/raw_bounce.h"

#include <glm/geometric.hpp>
#include <numbers>

#include "catch.h"
#include "cone/bounce.h"
#include "cone/volumes.h"
#include "settings.h"

using namespace voxref;

namespace {

constexpr float pi = std::numbers::pi_v<float>;
const glm::ivec3 size(32);

/// A pyramid whose levels all hold `texel` everywhere, whatever its base holds.
Pyramid uniform(const glm::vec4& base, const glm::vec4& texel) {
  Pyramid pyramid =
      mipmap(unit_grid(size), fill(size, [](const glm::ivec3&) { return glm::vec4(1.0f); }), MipmapOptions{});
  std::ranges::fill(pyramid.base.texels(), base);
  for (auto& level : pyramid.levels)
    for (DirectionalTexel& faces : level.texels()) faces.fill(texel);
  return pyramid;
}

float irradiance(Pyramid pyramid, const glm::ivec3& voxel, const glm::vec3& normal,
                 std::optional<float> max_distance = 0.95f) {
  return RawVoxelGatherer(RawVolume(std::move(pyramid)), max_distance).irradiance(voxel, normal).r;
}

}  // namespace

TEST_CASE("Opaque surroundings of one radiance give pi times it, and at most 1", "[raw_bounce]") {
  const glm::vec3 n = glm::normalize(glm::vec3(1, 2, -1));
  CHECK(irradiance(uniform({}, {0.2f, 0, 0, 1}), {16, 16, 16}, n) == Approx(0.2f * pi));
  CHECK(irradiance(uniform({}, {0.5f, 0, 0, 1}), {16, 16, 16}, n) == 1.0f);
}

TEST_CASE("The base is never read, not even at the first sample", "[raw_bounce]") {
  CHECK(irradiance(uniform({1, 1, 1, 1}, {0, 0, 0, 0}), {16, 16, 16}, {0, 1, 0}) == 0.0f);
}

TEST_CASE("Samples lie 2, 4, 8 and 16 voxels along the cone, up to the greatest distance", "[raw_bounce]") {
  // Transparent and glowing: every sample adds its radiance once. From a voxel whose cones stay inside.
  const Pyramid glow = uniform({}, {0.01f, 0, 0, 0});
  for (const auto& [max_distance, samples] :
       {std::pair{0.05f, 0}, {0.07f, 1}, {0.2f, 2}, {0.3f, 3}, {0.6f, 4}, {0.95f, 4}}) {
    CAPTURE(max_distance);
    CHECK(irradiance(glow, {16, 2, 16}, {0, 1, 0}, max_distance) == Approx(0.01f * pi * float(samples)).margin(1e-7));
  }
}

TEST_CASE("A cone whose first sample lies outside gets nothing; later ones see the edge go on", "[raw_bounce]") {
  const Pyramid glow = uniform({}, {0.01f, 0, 0, 0});
  CHECK(irradiance(glow, {16, 31, 16}, {0, 1, 0}) == 0.0f);  // at y = 31 + 2 + 2 and 31 + 2 + 1
  // At y = 26 all first samples are inside, all later ones of the upright cone outside.
  CHECK(irradiance(glow, {16, 26, 16}, {0, 1, 0}) == Approx(0.01f * pi * 4.0f));
}

TEST_CASE("Light is gathered from the voxel's corner, two voxels along the normal", "[raw_bounce]") {
  // Level 0 (cells of 2 voxels) glows in one layer of cells, y 20 to 22: the weight of its trilinear filter tells where
  // the sample is. From voxel y = 17 the upright cone's first sample is at y = 17 + 2 + 2 = 21, the layer's middle.
  Pyramid layer = uniform({}, glm::vec4(0));
  for (int z = 0; z < 16; ++z)
    for (int x = 0; x < 16; ++x) layer.levels[0]({x, 10, z}).fill({0.1f, 0, 0, 0});
  // The other three rise by cos: |(0, 0.866, 1)| and |(0.755, 0.433, 1)| are 1 / 0.7559 and 1 / 0.7543.
  const float cells = pi / 3.0f + 2.0f * pi / 9.0f * (0.7559f + 2.0f * 0.7543f);
  CHECK(irradiance(layer, {16, 17, 16}, {0, 1, 0}, 0.07f) == Approx(0.1f * cells).epsilon(1e-3));
}

TEST_CASE("With bytes several bounces saturate instead of being refused", "[raw_bounce]") {
  const SurfaceGrid surfaces = box_surfaces(glm::ivec3(16), 1.0f);
  const std::vector<glm::vec3> direct(surfaces.size(), glm::vec3(0.2f));
  const Settings settings = profile("villegas2016");
  BounceOptions options = settings.bounce;
  float before = 0.0f;
  for (int count = 1; count <= 4; ++count) {
    options.count = count;
    const auto result = bounce(surfaces, direct, mipmap<Rgba8>(surfaces, direct, settings.mipmap), options,
                               settings.render.cone, settings.mipmap, glm::vec3(0.0f));
    CHECK(result.bounces == count);
    float greatest = 0.0f;
    for (const glm::vec3& radiance : result.radiance) greatest = std::max(greatest, radiance.r);
    CHECK(greatest >= before);
    CHECK(greatest <= 1.0f);
    before = greatest;
  }
}
