#include "voxel/mipmap.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "catch.h"
#include "parallel.h"
#include "voxel/filled_volume.h"

using namespace voxref;

namespace {

const glm::vec4 red(1.0f, 0.0f, 0.0f, 1.0f), green(0.0f, 1.0f, 0.0f, 1.0f), clear(0.0f);

/// Random premultiplied texels; half of them empty.
Fill random_texels(unsigned seed, const glm::ivec3& size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<glm::vec4> texels;
  for_each_voxel(size, [&](const glm::ivec3&) {
    const float alpha = std::max(0.0f, 2.0f * uniform(random) - 1.0f);
    texels.push_back(alpha * glm::vec4(uniform(random), uniform(random), uniform(random), 1.0f));
  });
  return [=](const glm::ivec3& v) { return texels[v.x + size.x * (v.y + size.y * v.z)]; };
}

/// The definition, read off spec section 4 on dense arrays: the second algorithm.
std::vector<glm::vec4> coarser_by_definition(const std::vector<glm::vec4>& fine, const glm::ivec3& size, int face) {
  const auto at = [&](const glm::ivec3& v) {
    return v.x < size.x && v.y < size.y && v.z < size.z ? fine[v.x + size.x * (v.y + size.y * v.z)] : clear;
  };
  const int axis = face / 2, other = (axis + 1) % 3, third = (axis + 2) % 3;
  std::vector<glm::vec4> coarse;
  for_each_voxel((size + 1) / 2, [&](const glm::ivec3& v) {
    glm::dvec4 sum(0.0);
    for (int column = 0; column < 4; ++column) {
      glm::ivec3 low = 2 * v;
      low[other] += column & 1;
      low[third] += column >> 1;
      glm::ivec3 high = low;
      ++high[axis];
      const bool towards_negative = face % 2 == 0;
      const glm::dvec4 front(at(towards_negative ? high : low)), back(at(towards_negative ? low : high));
      sum += front + back * (1.0 - front.a);
    }
    coarse.push_back(glm::vec4(sum / 4.0));
  });
  return coarse;
}

/// Largest difference of a channel between a level and a constant.
float deviation(const BrickVolume<DirectionalTexel>& level, int face, const glm::vec4& expected) {
  float worst = 0.0f;
  for_each_voxel(level.size(), [&](const glm::ivec3& v) {
    for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(level(v)[face][c] - expected[c]));
  });
  return worst;
}

}  // namespace

TEST_CASE("levels halve the grid, rounding up, down to a single texel", "[mipmap]") {
  const Pyramid pyramid = filtered({20, 5, 9}, [](const glm::ivec3&) { return red; });
  const std::vector<glm::ivec3> sizes = {{10, 3, 5}, {5, 2, 3}, {3, 1, 2}, {2, 1, 1}, {1, 1, 1}};
  REQUIRE(pyramid.levels.size() == sizes.size());
  for (size_t k = 0; k < sizes.size(); ++k) CHECK(pyramid.levels[k].size() == sizes[k]);
}

TEST_CASE("a constant volume stays constant and an empty one empty", "[mipmap]") {
  const glm::vec4 constant(0.25f, 0.5f, 0.75f, 1.0f);
  for (const MipmapFilter filter : {MipmapFilter::anisotropic, MipmapFilter::isotropic}) {
    const Pyramid full = filtered(
        glm::ivec3(16), [&](const glm::ivec3&) { return constant; }, filter);
    const Pyramid empty = filtered(
        glm::ivec3(16), [](const glm::ivec3&) { return clear; }, filter);
    REQUIRE(full.levels.size() == 4);
    for (size_t k = 0; k < 4; ++k)
      for (int face = 0; face < 6; ++face) {
        CHECK(deviation(full.levels[k], face, constant) == 0.0f);
        CHECK(empty.levels[k].brick_count() == 0);
      }
  }
}

TEST_CASE("a translucent medium thickens as its layers do and keeps its colour", "[mipmap]") {
  const float alpha = 0.125f;
  const Pyramid pyramid = filtered(glm::ivec3(8), [&](const glm::ivec3&) { return alpha * glm::vec4(2, 1, 4, 1); });
  for (size_t k = 0; k < pyramid.levels.size(); ++k) {
    const float expected = 1.0f - std::pow(1.0f - alpha, float(2 << k));
    // Three levels of a few roundings each, of numbers up to 4.
    for (int face = 0; face < 6; ++face)
      CHECK(deviation(pyramid.levels[k], face, expected * glm::vec4(2, 1, 4, 1)) < 4e-6f);
  }
}

TEST_CASE("a ray reads the face named after its direction and meets the texel in front first", "[mipmap]") {
  for (int axis = 0; axis < 3; ++axis) {
    const Pyramid pyramid = filtered(glm::ivec3(2), [&](const glm::ivec3& v) { return v[axis] == 1 ? red : green; });
    const DirectionalTexel& texel = pyramid.levels[0]({0, 0, 0});
    INFO("axis " << axis);
    CHECK(texel[2 * axis] == red);        // towards the negative side: the higher coordinate is in front
    CHECK(texel[2 * axis + 1] == green);  // towards the positive side: the lower one
    for (int other = 0; other < 6; ++other)
      if (other / 2 != axis) CHECK(texel[other] == glm::vec4(0.5f, 0.5f, 0.0f, 1.0f));
  }
}

TEST_CASE("face names follow the order of the enumeration", "[mipmap]") {
  CHECK(face_names[size_t(Face::neg_x)] == "neg_x");
  CHECK(face_names[size_t(Face::pos_y)] == "pos_y");
  CHECK(face_names[size_t(Face::pos_z)] == "pos_z");
}

// Seen edge-on a wall covers half of a 2x2x2 block. Coarser blocks have two such texels behind each other; compositing
// takes what they cover as independent, so w_(k+1) = (1 - (1 - w_k)^2) / 2: 1, 1/2, 3/8, 0.305, and not 2^-k.
TEST_CASE("a slab one voxel thick stays opaque from the front and thins out edge-on", "[mipmap]") {
  for (int axis = 0; axis < 3; ++axis)
    for (int position = 0; position < 16; ++position) {
      const Fill slab = [&](const glm::ivec3& v) { return v[axis] == position ? red : clear; };
      const Pyramid pyramid = filtered(glm::ivec3(16), slab);
      const Pyramid mean = filtered(glm::ivec3(16), slab, MipmapFilter::isotropic);
      float edge_on = 1.0f, share = 1.0f;
      for (size_t k = 0; k < pyramid.levels.size(); ++k) {
        edge_on = 0.5f * (1.0f - (1.0f - edge_on) * (1.0f - edge_on));
        share *= 0.5f;
        glm::ivec3 at(0);
        at[axis] = position >> (k + 1);
        for (int face = 0; face < 6; ++face) {
          // 4e-7: four levels of roundings below 1/4 ulp of 1; frontally all is exact.
          const float expected = face / 2 == axis ? 1.0f : edge_on, tolerance = face / 2 == axis ? 0.0f : 4e-7f;
          CHECK(std::abs(pyramid.levels[k](at)[face].a - expected) <= tolerance);
          CHECK(pyramid.levels[k](at)[face].r == pyramid.levels[k](at)[face].a);
          CHECK(mean.levels[k](at)[face] == share * red);  // the isotropic filter lets light through at every level
        }
      }
    }
}

TEST_CASE("a single voxel keeps its projected area", "[mipmap]") {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const glm::ivec3 voxel(random() % 32, random() % 32, random() % 32);
    const Pyramid pyramid = filtered(glm::ivec3(32), [&](const glm::ivec3& v) { return v == voxel ? green : clear; });
    for (size_t k = 0; k < pyramid.levels.size(); ++k)
      for (int face = 0; face < 6; ++face)
        CHECK(pyramid.levels[k](voxel >> int(k + 1))[face] == std::pow(0.25f, float(k + 1)) * green);
  }
}

TEST_CASE("a checkerboard is opaque from every side and half transparent to the isotropic filter", "[mipmap]") {
  const Fill board = [](const glm::ivec3& v) { return (v.x + v.y + v.z) % 2 == 0 ? red : clear; };
  const Pyramid pyramid = filtered(glm::ivec3(16), board),
                mean = filtered(glm::ivec3(16), board, MipmapFilter::isotropic);
  for (size_t k = 0; k < pyramid.levels.size(); ++k)
    for (int face = 0; face < 6; ++face) {
      CHECK(deviation(pyramid.levels[k], face, red) == 0.0f);
      CHECK(deviation(mean.levels[k], face, 0.5f * red) == 0.0f);
    }
}

TEST_CASE("an edge of two walls is opaque across and closes as its two walls do, seen along it", "[mipmap]") {
  const Pyramid pyramid =
      filtered(glm::ivec3(16), [](const glm::ivec3& v) { return v.x == 0 || v.y == 0 ? green : clear; });
  double wall = 1.0, edge = 1.0;  // opacity along z of a block with one wall, and with both
  const auto twice = [](double a) { return 1.0 - (1.0 - a) * (1.0 - a); };
  for (const auto& level : pyramid.levels) {
    edge = (twice(edge) + 2.0 * twice(wall)) / 4.0;  // the block in the corner, two walls beside it, and nothing
    wall = twice(wall) / 2.0;
    const DirectionalTexel& corner = level({0, 0, 0});
    for (int face = 0; face < 4; ++face) CHECK(corner[face] == green);
    for (int face = 4; face < 6; ++face) CHECK(std::abs(corner[face].a - edge) < 4e-7);  // roundings of four levels
  }
  CHECK(pyramid.levels[0]({0, 0, 0})[size_t(Face::pos_z)].a == 0.75f);
}

TEST_CASE("of a red and a green wall back to back each side sees its own, but for the isotropic filter", "[mipmap]") {
  for (const int position : {6, 7}) {  // within a 2x2x2 block, and across two
    const Fill walls = [&](const glm::ivec3& v) { return v.x == position ? red : v.x == position + 1 ? green : clear; };
    const Pyramid pyramid = filtered(glm::ivec3(16), walls),
                  mean = filtered(glm::ivec3(16), walls, MipmapFilter::isotropic);
    const DirectionalTexel& whole = pyramid.levels.back()({0, 0, 0});
    CHECK(whole[size_t(Face::pos_x)] == red);
    CHECK(whole[size_t(Face::neg_x)] == green);
    const glm::vec4 mixed = mean.levels.back()({0, 0, 0})[size_t(Face::pos_x)];
    CHECK(mixed.r > 0.0f);
    CHECK(mixed.r == mixed.g);
  }
}

TEST_CASE("layers composite to the same value level by level and one after the other", "[mipmap]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<glm::vec4> layers(16);
  for (glm::vec4& layer : layers) {
    const float alpha = uniform(random) * 0.5f;
    layer = alpha * glm::vec4(uniform(random), uniform(random), uniform(random), 1.0f);
  }
  const Pyramid pyramid = filtered(glm::ivec3(16), [&](const glm::ivec3& v) { return layers[v.y]; });
  glm::dvec4 up(0.0), down(0.0);
  for (int i = 0; i < 16; ++i) up += (1.0 - up.a) * glm::dvec4(layers[i]);
  for (int i = 15; i >= 0; --i) down += (1.0 - down.a) * glm::dvec4(layers[i]);
  for (int c = 0; c < 4; ++c) {
    // Four levels of three roundings each, values up to 1.
    CHECK(std::abs(pyramid.levels[3]({0, 0, 0})[size_t(Face::pos_y)][c] - up[c]) < 1e-6);
    CHECK(std::abs(pyramid.levels[3]({0, 0, 0})[size_t(Face::neg_y)][c] - down[c]) < 1e-6);
  }
}

TEST_CASE("every level is what the definition gives on dense arrays", "[mipmap]") {
  for (const glm::ivec3& size : {glm::ivec3(16), glm::ivec3(13, 21, 9), glm::ivec3(1, 30, 2)}) {
    const Fill fill = random_texels(11, size);
    const Pyramid pyramid = filtered(size, fill);
    for (int face = 0; face < 6; ++face) {
      std::vector<glm::vec4> dense;
      for_each_voxel(size, [&](const glm::ivec3& v) { dense.push_back(fill(v)); });
      glm::ivec3 fine = size;
      for (const auto& level : pyramid.levels) {
        dense = coarser_by_definition(dense, fine, face);
        fine = (fine + 1) / 2;
        REQUIRE(level.size() == fine);
        float worst = 0.0f;
        size_t i = 0;
        for_each_voxel(fine, [&](const glm::ivec3& v) {
          for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(level(v)[face][c] - dense[i][c]));
          ++i;
        });
        CHECK(worst < 5e-7f);  // some eight roundings of values below 1, which later levels only average
      }
    }
  }
}

TEST_CASE("opacity stays in [0,1] and colour below opacity times the largest radiance", "[mipmap]") {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Fill sparse = random_texels(seed, glm::ivec3(32));
    // Translucent before opaque: sums of columns then round to either side of 1.
    const Fill dense = [&](const glm::ivec3& v) {
      const glm::vec4 t = sparse(v);
      return (v.x + v.y + v.z) % 2 ? glm::vec4(t.r, t.g, t.b, 1.0f) : t;
    };
    for (const Fill& fill : {sparse, dense})
      for (const auto& level : filtered(glm::ivec3(32), fill).levels)
        for (const DirectionalTexel& texel : level.texels())
          for (const glm::vec4& face : texel) {
            REQUIRE(face.a >= 0.0f);
            REQUIRE(face.a <= 1.0f);
            // Radiance is at most 1 here; 1e-6: roundings.
            REQUIRE(std::max({face.r, face.g, face.b}) <= face.a + 1e-6f);
          }
  }
}

TEST_CASE("odd sides lose no voxel and count none twice", "[mipmap]") {
  const glm::ivec3 size(13, 7, 21);
  // The isotropic filter averages: eight times the sum of a level is the sum of the one below.
  std::mt19937 random(9);
  std::vector<float> alphas(size.x * size.y * size.z);
  for (float& alpha : alphas) alpha = 0.5f * float(random() % 3);
  const Pyramid mean = filtered(
      size, [&](const glm::ivec3& v) { return glm::vec4(alphas[v.x + size.x * (v.y + size.y * v.z)]); },
      MipmapFilter::isotropic);
  double below = 0.0;
  for (const float alpha : alphas) below += alpha;
  for (const auto& level : mean.levels) {
    double sum = 0.0;
    for (const DirectionalTexel& texel : level.texels()) sum += texel[0].a;
    CHECK(8.0 * sum == below);
    below = sum;
  }
  // A sheet seen from the front: a quarter per level.
  const Pyramid sheet = filtered(size, [&](const glm::ivec3& v) { return v.z == 20 ? red : clear; });
  double area = size.x * size.y;
  for (const auto& level : sheet.levels) {
    double sum = 0.0;
    for (const DirectionalTexel& texel : level.texels()) sum += texel[size_t(Face::pos_z)].a;
    CHECK(4.0 * sum == area);
    area = sum;
  }
}

TEST_CASE("surfaces enter the base premultiplied, and only their bricks take memory", "[mipmap]") {
  SurfaceGrid surfaces;
  surfaces.grid.size = glm::ivec3(64);
  surfaces.voxels = {{1, 2, 3}, {60, 2, 3}};
  surfaces.albedo = {{0.5f, 0.5f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 0.25f}};
  const std::vector<glm::vec3> radiance = {{1, 2, 3}, {4, 8, 12}};
  const Pyramid pyramid = mipmap(surfaces, radiance, {});
  CHECK(pyramid.base({1, 2, 3}) == glm::vec4(1, 2, 3, 1));
  CHECK(pyramid.base({60, 2, 3}) == glm::vec4(1, 2, 3, 0.25f));
  CHECK(pyramid.base.brick_count() == 2);
  CHECK(pyramid.levels[0].brick_count() == 2);
  CHECK(pyramid.levels[1].brick_count() == 2);
  CHECK(pyramid.levels[2].brick_count() == 1);
  CHECK(pyramid.levels[2]({0, 0, 0})[0] == glm::vec4(1, 2, 3, 1) / 64.0f);
  size_t texels = pyramid.base.texels().size_bytes();
  for (const auto& level : pyramid.levels) texels += level.texels().size_bytes();
  CHECK(pyramid.bytes() >= texels);
  CHECK(pyramid.bytes() < texels + 4096);  // the brick tables: 8^3 entries and less
}

TEST_CASE("mipmaps have the same bits on one thread and on two", "[mipmap]") {
  const glm::ivec3 size(40, 24, 56);
  const Fill fill = random_texels(2, size);
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return filtered(size, fill);
  };
  const Pyramid one = with(1), two = with(2);
  for (size_t k = 0; k < one.levels.size(); ++k)
    CHECK(std::ranges::equal(one.levels[k].texels(), two.levels[k].texels()));
}

TEST_CASE("a cancelled mipmap ends with an interruption", "[mipmap]") {
  const std::atomic<bool> cancel = true;
  Progress progress;
  progress.cancel = &cancel;
  CHECK_THROWS_AS(mipmap(Grid{glm::ivec3(16), glm::vec3(0.0f), 1.0f},
                         make_base(glm::ivec3(16), [](const glm::ivec3&) { return red; }), {}, progress),
                  Interrupted);
}
