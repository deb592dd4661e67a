#include <algorithm>
#include <array>
#include <bit>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "catch.h"
#include "voxel/filled_volume.h"

namespace voxref {

namespace {

/// Units in the last place by which each level's faces change, at most, when a volume of side 8 is turned and mirrored.
std::vector<int> change_by_symmetry(const Fill& fill) {
  const int side = 8;
  const Pyramid original = filtered(glm::ivec3(side), fill);
  std::vector<int> largest(original.levels.size(), 0);
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int flips = 0; flips < 8; ++flips) {
      // Coordinate axes[a] of the original becomes coordinate a, mirrored where bit a is set.
      const auto back = [&](const glm::ivec3& v, int size) {
        glm::ivec3 result;
        for (int a = 0; a < 3; ++a) result[axes[a]] = flips >> a & 1 ? size - 1 - v[a] : v[a];
        return result;
      };
      const Pyramid moved = filtered(glm::ivec3(side), [&](const glm::ivec3& v) { return fill(back(v, side)); });
      for (size_t k = 0; k < original.levels.size(); ++k)
        for_each_voxel(moved.levels[k].size(), [&](const glm::ivec3& v) {
          const DirectionalTexel& from = original.levels[k](back(v, moved.levels[k].size().x));
          for (int a = 0; a < 3; ++a)
            for (int sign = 0; sign < 2; ++sign)
              for (int c = 0; c < 4; ++c)
                // Floats of one sign are ordered as their bits are.
                largest[k] = std::max(largest[k],
                                      std::abs(std::bit_cast<int>(moved.levels[k](v)[2 * a + sign][c]) -
                                               std::bit_cast<int>(from[2 * axes[a] + (sign ^ (flips >> a & 1))][c])));
        });
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return largest;
}

}  // namespace

TEST_CASE("faces permute as the volume does under the cube's 48 symmetries, to the bit for dyadic data", "[mipmap]") {
  std::mt19937 random(5);
  std::vector<glm::vec4> texels(8 * 8 * 8);
  const Fill fill = [&](const glm::ivec3& v) { return texels[v.x + 8 * (v.y + 8 * v.z)]; };
  // Opacities 0, 1/2, 1 and radiances 1/2, 1 need at most 24 bits after three levels.
  for (glm::vec4& texel : texels) {
    const float alpha = 0.5f * float(random() % 3);
    const auto radiance = [&] { return 0.5f * float(1 + random() % 2); };
    texel = alpha * glm::vec4(radiance(), radiance(), radiance(), 1.0f);
  }
  for (const int change : change_by_symmetry(fill)) CHECK(change == 0);
  // Of other data columns are added in other pairs where axes change places, at every level.
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (glm::vec4& texel : texels)
    texel = uniform(random) * glm::vec4(uniform(random), uniform(random), uniform(random), 1.0f);
  const std::vector<int> changes = change_by_symmetry(fill);
  for (size_t k = 0; k < changes.size(); ++k) CHECK(changes[k] <= 2 * static_cast<int>(k + 1));
}

TEST_CASE("a ball's opacity is that of its chords", "[mipmap]") {
  // A chord of n voxels lies in (n + 1) / 2 pairs of voxels in the mean over where the pairs begin. Over all chords of
  // a ball these are (V + A) / 2, with its volume and the area of its shadow, and each is a quarter of a texel's face.
  const float radius = 20.3f;
  const Pyramid pyramid = filtered(glm::ivec3(64), [&](const glm::ivec3& v) {
    return glm::distance(glm::vec3(v) + 0.5f, glm::vec3(31.7f, 32.2f, 31.9f)) < radius ? glm::vec4(1.0f)
                                                                                       : glm::vec4(0.0f);
  });
  const double area = std::numbers::pi * radius * radius, volume = 4.0 / 3.0 * area * radius;
  for (size_t face = 0; face < 6; ++face) {
    double opacity = 0.0;
    for_each_voxel(pyramid.levels[0].size(), [&](const glm::ivec3& v) { opacity += pyramid.levels[0](v)[face].a; });
    // Some 1,300 chords end at random places: 1 / sqrt(1300) of half a pair each, and volume and area as well.
    CHECK(opacity == Approx((volume + area) / 8.0).epsilon(0.005));
  }
}

}  // namespace voxref
