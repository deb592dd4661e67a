#include "cone/medium.h"

#include <cmath>

#include "catch.h"
#include "cone/volumes.h"

using namespace voxref;

TEST_CASE("A texel becomes extinction per voxel length and extinction times its colour", "[medium]") {
  const glm::vec3 radiance(3.0f, 0.5f, 0.0f);
  const float opacity = 0.6f;
  const Medium medium =
      fill_medium({16, 16, 16}, [&](const glm::ivec3&) { return glm::vec4(opacity * radiance, opacity); });
  const float sigma = -std::log(1.0f - opacity);
  const glm::vec4 base = medium.texels.base({3, 4, 5});
  CHECK(base.a == Approx(sigma).epsilon(1e-6));
  for (int c = 0; c < 3; ++c) CHECK(base[c] == Approx(sigma * radiance[c]).epsilon(1e-6));

  // A homogeneous medium has the same extinction per length at every level: crossing 2^k voxels leaves (1 - a)^(2^k).
  // Only while that is above the floor of 1e-4, up to level 3 ((0.4)^8 = 7e-4); 1 - a cancels 3 digits there.
  for (int level = 1; level <= 3; ++level)
    for (const glm::vec4& face : medium.texels.levels[size_t(level - 1)]({0, 0, 0})) {
      CHECK(face.a == Approx(sigma).epsilon(1e-3));
      for (int c = 0; c < 3; ++c) CHECK(face[c] == Approx(sigma * radiance[c]).epsilon(1e-3));
    }
}

TEST_CASE("An opaque texel transmits 1e-4 of the light through its cell, an empty one has no extinction", "[medium]") {
  const Medium medium = fill_medium(
      {16, 16, 16}, [](const glm::ivec3& v) { return v.x == 4 ? glm::vec4(0.0f, 0.0f, 0.0f, 1.0f) : glm::vec4(0.0f); });
  CHECK(std::exp(-medium.texels.base({4, 0, 0}).a) == Approx(1e-4).epsilon(1e-3));  // 1 - (1 - 1e-4) in float
  CHECK(medium.texels.base({5, 0, 0}).a == 0.0f);
  const glm::vec4 face = medium.texels.levels[0]({2, 0, 0})[size_t(Face::pos_x)];
  CHECK(std::exp(-2.0f * face.a) == Approx(1e-4).epsilon(1e-3));
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
