#include "voxel/texel.h"

#include <cmath>
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

TEST_CASE("Floats are stored as they are", "[texel]") {
  const Float4 value{1.5f, -2.0f, 1e-30f, 0.25f};
  CHECK(to_vec4(decode(encode<glm::vec4>(value))) == to_vec4(value));
  CHECK(stored<glm::vec4>(glm::vec3(7.0f)) == glm::vec3(7.0f));
  CHECK(stored<Rgba8>(glm::vec3(7.0f, 0.0f, 0.5f)) == glm::vec3(1.0f, 0.0f, 128.0f * (1.0f / 255.0f)));
}
