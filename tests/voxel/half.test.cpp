#include "voxel/half.h"

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.h"

using namespace voxref;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// IEEE 754-2008, 3.4: sign, 5 bits of exponent with bias 15, 10 bits of mantissa.
float by_definition(uint16_t half) {
  const int exponent = half >> 10 & 31, mantissa = half & 1023;
  const double sign = half & 0x8000 ? -1.0 : 1.0;
  if (exponent == 31) return mantissa == 0 ? float(sign) * infinity : std::nanf("");
  if (exponent == 0) return float(sign * std::ldexp(mantissa, -24));
  return float(sign * std::ldexp(1024 + mantissa, exponent - 25));
}

float from_half(uint16_t half) { return from_halves({0, half, 0, 0x3c00})[1]; }
uint16_t to_half(float value) { return to_halves(Float4{0.0f, 1.0f, value, 0.0f})[2]; }

}  // namespace

TEST_CASE("Each of the 65536 half floats decodes to what its bits mean, and encodes to itself", "[texel]") {
  size_t wrong = 0, changed = 0;
  for (uint32_t half = 0; half < 65536; ++half) {
    const float value = from_half(uint16_t(half)), truth = by_definition(uint16_t(half));
    const uint16_t back = to_half(value);
    if (std::isnan(truth)) {
      wrong += !std::isnan(value);
      changed += !std::isnan(by_definition(back));
      continue;
    }
    wrong += std::bit_cast<uint32_t>(value) != std::bit_cast<uint32_t>(truth);  // the sign of zero too
    changed += back != half;
  }
  CHECK(wrong == 0);
  CHECK(changed == 0);
}

TEST_CASE("Between two half floats values go to the nearer one, from the middle to the even one", "[texel]") {
  size_t wrong = 0;
  for (const uint32_t sign : {0u, 0x8000u})
    for (uint32_t half = 0; half < 0x7c00; ++half) {
      const uint16_t low = uint16_t(half | sign), high = uint16_t((half + 1) | sign);
      // Beyond the greatest there would be 65536, if the exponent went on: from the middle on halves are infinite.
      const double upper = half == 0x7bff ? (sign ? -65536.0 : 65536.0) : double(by_definition(high));
      const float middle = float(0.5 * (double(by_definition(low)) + upper));  // exact: one bit more than a half has
      wrong += to_half(middle) != (half % 2 == 0 ? low : high);
      wrong += to_half(std::nextafter(middle, 0.0f)) != low;
      wrong += to_half(std::nextafter(middle, sign ? -infinity : infinity)) != high;
    }
  CHECK(wrong == 0);
}

TEST_CASE("Far outside of the half floats' range values become zero and infinity, and NaN stays", "[texel]") {
  CHECK(to_half(1e-30f) == 0);
  CHECK(to_half(-1e-30f) == 0x8000);
  CHECK(to_half(std::numeric_limits<float>::denorm_min()) == 0);
  CHECK(to_half(std::numeric_limits<float>::max()) == 0x7c00);
  CHECK(to_half(-infinity) == 0xfc00);
  CHECK(std::isnan(from_half(to_half(std::nanf("")))));
  CHECK(std::isnan(from_half(to_half(-std::nanf("")))));
}

TEST_CASE("The four half floats of a texel do not mix", "[texel]") {
  const Float4 value = from_halves(to_halves(Float4{1.0f, -2.5f, 0.0f, 65504.0f}));
  CHECK(to_vec4(value) == glm::vec4(1.0f, -2.5f, 0.0f, 65504.0f));
}
