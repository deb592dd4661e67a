#pragma once
#include <emmintrin.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "cone/float4.h"

namespace voxref {

/// How volumes of radiance and opacity hold their numbers.
enum class Storage : uint8_t {
  float32,
  unorm8  ///< bytes, [0,1] in steps of 1/255: what the published shaders use, and what clamps radiance above 1
};

/// A texel of four bytes. Absent texels are zero in every storage.
struct Rgba8 {
  std::array<uint8_t, 4> bytes{};
  bool operator==(const Rgba8&) const = default;
};

/// A texel's value. A byte decodes by a multiplication, as GPUs do it: division differs in the last bit for half of all
/// bytes, which moves up to 9 % of the texels of filtered volumes by 1 (spec section 4).
inline Float4 decode(const glm::vec4& texel) { return load(texel); }
inline Float4 decode(const Rgba8& texel) {
  constexpr float step = 1.0f / 255.0f;
  int32_t packed;
  std::memcpy(&packed, texel.bytes.data(), sizeof packed);
  const __m128i zero = _mm_setzero_si128();
  const __m128i wide = _mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128(packed), zero), zero);
  return reinterpret_cast<Float4>(_mm_cvtepi32_ps(wide)) * step;
}

/// The fourth channel alone; the same bits.
inline float decode_alpha(const glm::vec4& texel) { return texel.a; }
inline float decode_alpha(const Rgba8& texel) { return static_cast<float>(texel.bytes[3]) * (1.0f / 255.0f); }

/// The texel that holds `value`: exactly, or clamped to [0,1] and rounded to the nearest byte, ties to even. A NaN in
/// unorm8 becomes 0.
template <class Texel>
Texel encode(const Float4& value);
template <>
inline glm::vec4 encode<glm::vec4>(const Float4& value) {
  return to_vec4(value);
}
template <>
inline Rgba8 encode<Rgba8>(const Float4& value) {
  // min and max return the second operand when either is NaN. The conversion rounds to nearest even.
  const __m128 clamped = _mm_min_ps(_mm_max_ps(reinterpret_cast<__m128>(value), _mm_setzero_ps()), _mm_set1_ps(1.0f));
  const __m128i wide = _mm_cvtps_epi32(_mm_mul_ps(clamped, _mm_set1_ps(255.0f)));
  const __m128i narrow = _mm_packs_epi32(wide, wide);
  const int32_t packed = _mm_cvtsi128_si32(_mm_packus_epi16(narrow, narrow));
  Rgba8 texel;
  std::memcpy(texel.bytes.data(), &packed, sizeof packed);
  return texel;
}

/// What is read of a colour that was stored.
template <class Texel>
glm::vec3 stored(const glm::vec3& color) {
  return glm::vec3(to_vec4(decode(encode<Texel>(load(glm::vec4(color, 1.0f))))));
}

/// Six faces of one texel side by side (see Face).
template <class Texel>
using Directional = std::array<Texel, 6>;

}  // namespace voxref
