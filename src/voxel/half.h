#pragma once
#include <emmintrin.h>

#include <array>
#include <cstdint>
#include <cstring>

#include "voxel/float4.h"

namespace voxref {

/// Four half floats, IEEE 754 binary16: 11 significant bits, 2^-24 to 65504. Converted here rather than by F16C, so
/// that every machine has the same bits.
using Half4 = std::array<uint16_t, 4>;

inline constexpr float greatest_half = 65504.0f;

namespace half_detail {
inline constexpr int32_t sign_bit = INT32_MIN;
inline constexpr int32_t infinity = 0x7f800000;  ///< float32's; above it are the NaNs
}  // namespace half_detail

/// Exact; NaN stays NaN.
inline Float4 from_halves(const Half4& halves) {
  using namespace half_detail;
  int64_t packed;
  std::memcpy(&packed, halves.data(), sizeof packed);
  const Int4 bits = reinterpret_cast<Int4>(_mm_unpacklo_epi16(_mm_cvtsi64_si128(packed), _mm_setzero_si128()));
  // In the places of float32 the exponent is too small by 127 - 15; the product is exact and makes denormals normal.
  const Int4 moved = (bits & 0x7fff) << 13;
  const Int4 finite = reinterpret_cast<Int4>(reinterpret_cast<Float4>(moved) * 0x1p112f);
  const Int4 special = (moved >= (0x7c00 << 13)) & infinity;
  return reinterpret_cast<Float4>(finite | special | ((bits & 0x8000) << 16));
}

/// Rounded to nearest, ties to even; from 65520 on infinity; NaN stays NaN.
inline Half4 to_halves(const Float4& value) {
  using namespace half_detail;
  constexpr int32_t least_normal = 0x38800000, overflow = 0x477ff000;  // 2^-14 and 65520 as float32
  const Int4 bits = reinterpret_cast<Int4>(value), magnitude = bits & ~sign_bit;
  // Thirteen bits go: adding just less than half of their unit, or half where the last bit that stays is odd, carries
  // into the rest as rounding should.
  const Int4 normal = (magnitude - (112 << 23) + 0xfff + ((magnitude >> 13) & 1)) >> 13;
  // In a float32 from 1/2 to 1 the last bit is 2^-24, as in halves below 2^-14: the sum rounds to it.
  const Int4 denormal = reinterpret_cast<Int4>(reinterpret_cast<Float4>(magnitude) + 0.5f) - 0x3f000000;
  const Int4 special = magnitude > infinity ? Int4{} + 0x7e00 : Int4{} + 0x7c00;
  Int4 half = magnitude < least_normal ? denormal : normal;
  half = magnitude < overflow ? half : special;
  half = (half << 16 | (bits & sign_bit)) >> 16;  // as signed 16-bit numbers, which the packing keeps
  const __m128i narrow = _mm_packs_epi32(reinterpret_cast<__m128i>(half), reinterpret_cast<__m128i>(half));
  const int64_t packed = _mm_cvtsi128_si64(narrow);
  Half4 halves;
  std::memcpy(halves.data(), &packed, sizeof packed);
  return halves;
}

}  // namespace voxref
