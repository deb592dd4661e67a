#include "voxel/texel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "catch.h"

using namespace voxref;

namespace {

Rgba8 bytes(uint8_t r, uint8_t g, uint8_t b, uint8_t a) { return {{r, g, b, a}}; }

}  // namespace

TEST_CASE("Bytes decode by a multiplication, which differs from a division", "[texel]") {
  int different = 0;
  for (int b = 0; b < 256; ++b) {
    const Float4 value = decode(bytes(uint8_t(b), 0, 255, uint8_t(255 - b)));
    CHECK(value[0] == float(b) * (1.0f / 255.0f));
    CHECK(value[3] == float(255 - b) * (1.0f / 255.0f));
    different += value[0] != float(b) / 255.0f;
  }
  CHECK(different > 100);  // of 256, by one unit in the last place
  CHECK(decode(bytes(0, 0, 0, 0))[0] == 0.0f);
  CHECK(decode(bytes(255, 0, 0, 0))[0] == 1.0f);
}

TEST_CASE("Every byte survives decoding and encoding", "[texel]") {
  for (int b = 0; b < 256; ++b) {
    const Rgba8 texel = bytes(uint8_t(b), uint8_t(255 - b), 0, 7);
    CHECK(encode<Rgba8>(decode(texel)) == texel);
  }
}

TEST_CASE("Values are clamped to [0,1] and rounded to the nearest byte, ties to even", "[texel]") {
  // 0.5 is 127.5 and goes to the even 128; the double below is the tie 2.5 in float32 too.
  const float tie = 2.5f / 255.0f;
  REQUIRE(tie * 255.0f == 2.5f);
  CHECK(encode<Rgba8>(Float4{0.5f, tie, 1.7f, -3.0f}) == bytes(128, 2, 255, 0));
  CHECK(encode<Rgba8>(Float4{126.6f / 255.0f, 126.4f / 255.0f, 1.0f, 0.0f}) == bytes(127, 126, 255, 0));
  const float infinity = std::numeric_limits<float>::infinity();
  CHECK(encode<Rgba8>(Float4{infinity, -infinity, std::nanf(""), 1e-9f}) == bytes(255, 0, 0, 0));
}

TEST_CASE("Half floats hold up to 65504, and what is brighter is clamped", "[texel]") {
  const float infinity = std::numeric_limits<float>::infinity();
  const Float4 value = decode(encode<Rgba16f>(Float4{infinity, 70000.0f, -1e9f, 65519.0f}));
  CHECK(to_vec4(value) == glm::vec4(65504.0f, 65504.0f, -65504.0f, 65504.0f));
  const Float4 bad = decode(encode<Rgba16f>(Float4{std::nanf(""), 1.0f, -std::nanf(""), 0.5f}));
  CHECK(std::isnan(bad[0]));
  CHECK(std::isnan(bad[2]));
  CHECK(decode_alpha(encode<Rgba16f>(Float4{0.0f, 0.0f, 0.0f, 0.375f})) == 0.375f);
}

TEST_CASE("Floats are stored as they are", "[texel]") {
  const Float4 value{1.5f, -2.0f, 1e-30f, 0.25f};
  CHECK(to_vec4(decode(encode<glm::vec4>(value))) == to_vec4(value));
}

TEST_CASE("Radiance that is clamped is counted by voxel, with the brightest channel", "[texel]") {
  Clamping floats, halves, bytes;
  for (const glm::vec3& color : {glm::vec3(7.0f, 0.0f, 0.5f), glm::vec3(1.0f), glm::vec3(0.0f, 1e5f, 2.0f)}) {
    CHECK(floats.store<glm::vec4>(color) == color);
    CHECK(bytes.store<Rgba8>(color).x == std::min(color.x, 1.0f));
    CHECK(halves.store<Rgba16f>(color) == glm::min(color, glm::vec3(65504.0f)));
  }
  CHECK(floats.voxels == 0);
  CHECK(halves.voxels == 1);
  CHECK(bytes.voxels == 2);
  CHECK(bytes.brightest == 1e5f);
  CHECK(Clamping().store<Rgba8>(glm::vec3(7.0f, 0.0f, 0.5f)) == glm::vec3(1.0f, 0.0f, 128.0f * (1.0f / 255.0f)));
  bytes += halves;
  CHECK(bytes.voxels == 3);
}
