#include "cone/medium.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "catch.h"
#include "cone/optical_texel.h"
#include "cone/volumes.h"

using namespace voxref;

TEST_CASE("A texel becomes the optical depth of its cell, and depth times its colour", "[medium]") {
  const glm::vec3 radiance(3.0f, 0.5f, 0.0f);
  const float opacity = 0.6f;
  const Medium medium =
      fill_medium({16, 16, 16}, [&](const glm::ivec3&) { return glm::vec4(opacity * radiance, opacity); });
  const float depth = -std::log(1.0f - opacity);
  const glm::vec4 base = medium.texels.base({3, 4, 5});
  CHECK(base.a == Approx(depth).epsilon(1e-6));
  for (int c = 0; c < 3; ++c) CHECK(base[c] == Approx(depth * radiance[c]).epsilon(1e-6));

  // A homogeneous medium has the same extinction per length at every level: crossing 2^k voxels leaves (1 - a)^(2^k).
  // Only while that is above the floor of 1e-4, up to level 3 ((0.4)^8 = 7e-4); 1 - a cancels 3 digits there.
  for (int level = 1; level <= 3; ++level)
    for (const glm::vec4& face : medium.texels.levels[size_t(level - 1)]({0, 0, 0})) {
      const float across = Medium::cell(level) * depth;
      CHECK(face.a == Approx(across).epsilon(1e-3));
      for (int c = 0; c < 3; ++c) CHECK(face[c] == Approx(across * radiance[c]).epsilon(1e-3));
    }
}

TEST_CASE("An opaque texel transmits 1e-4 of the light through its cell, an empty one has no extinction", "[medium]") {
  const Medium medium = fill_medium(
      {16, 16, 16}, [](const glm::ivec3& v) { return v.x == 4 ? glm::vec4(0.0f, 0.0f, 0.0f, 1.0f) : glm::vec4(0.0f); });
  CHECK(std::exp(-medium.texels.base({4, 0, 0}).a) == Approx(1e-4).epsilon(1e-3));  // 1 - (1 - 1e-4) in float
  CHECK(medium.texels.base({5, 0, 0}).a == 0.0f);
  const glm::vec4 face = medium.texels.levels[0]({2, 0, 0})[size_t(Face::pos_x)];
  CHECK(std::exp(-face.a) == Approx(1e-4).epsilon(1e-3));
}

TEST_CASE("Half floats and bytes hold the same medium, as finely as they can", "[medium]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec4 lit(uniform(random), uniform(random), uniform(random), 1.0f);
    const float opacity = decode_alpha(encode<Rgba8>(Float4{0.0f, 0.0f, 0.0f, uniform(random)}));
    const glm::vec4 texel(opacity * glm::vec3(lit), opacity);
    const float depth = optical_depth(opacity);
    const glm::vec4 plain = to_vec4(optical(optical_texel<glm::vec4>(texel, depth)));
    const glm::vec4 half = optical_unit<Rgba16f> * to_vec4(optical(optical_texel<Rgba16f>(texel, depth)));
    const glm::vec4 byte = to_vec4(optical(optical_texel<Rgba8>(texel, depth)));
    CHECK(byte.a == Approx(plain.a).epsilon(1e-3));  // the opacity is one of the bytes: at 1, 1 - 1e-4 in float
    for (int c = 0; c < 4; ++c) CHECK(half[c] == Approx(plain[c]).epsilon(1.0 / 2048).margin(1e-6));
    // Half a step of 1/255 in premultiplied radiance.
    for (int c = 0; c < 3; ++c)
      CHECK(std::abs(byte[c] - plain[c]) <= 0.501f / 255.0f * depth / std::max(opacity, 1e-6f));
  }
  // Joined with its neighbours, a texel is more opaque, and its colour stays.
  const glm::vec4 joined = to_vec4(optical(optical_texel<Rgba8>({0.2f, 0.1f, 0.0f, 0.5f}, -std::log(0.25f))));
  CHECK(joined.a == Approx(-std::log(0.25f)).epsilon(0.01));
  CHECK(joined.r / joined.a == Approx(0.4f).epsilon(0.01));
  // The brightest radiance that half floats hold, in an opaque texel.
  const glm::vec4 bright = to_vec4(optical(optical_texel<Rgba16f>({65504.0f, 0.0f, 0.0f, 1.0f}, optical_depth(1.0f))));
  CHECK(bright.r / bright.a == Approx(65504.0f).epsilon(1e-3));
}

TEST_CASE("A texel that is not a number stays visible as such", "[medium]") {
  BrickVolume<glm::vec4> base = fill({4, 4, 4}, [](const glm::ivec3&) { return glm::vec4(1.0f); });
  base({1, 1, 1}).a = std::nanf("");
  base({2, 1, 1}).r = std::nanf("");
  const Medium medium = make_medium(Pyramid{unit_grid({4, 4, 4}), std::move(base), {}});
  CHECK(std::isnan(medium.texels.base({1, 1, 1}).a));
  CHECK(std::isnan(medium.texels.base({2, 1, 1}).r));
}

TEST_CASE("The opacity medium is the base volume of the whole medium, without colour", "[medium]") {
  const SurfaceGrid surfaces = box_surfaces({20, 12, 9}, 0.5f);
  const Medium medium = make_opacity_medium(surfaces);
  const std::vector<glm::vec3> dark(surfaces.size(), glm::vec3(0.0f));
  const Medium whole = make_medium(mipmap(surfaces, dark, MipmapOptions{}));
  CHECK(medium.top() == 0);
  for (int z = -1; z <= 9; ++z)
    for (int y = -1; y <= 12; ++y)
      for (int x = -1; x <= 20; ++x) {
        const BrickVolume<glm::vec4>& a = medium.texels.base;
        const BrickVolume<glm::vec4>& b = whole.texels.base;
        REQUIRE(a({x, y, z}) == b({x, y, z}));
      }
}
