#pragma once
#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <string_view>
#include <type_traits>

#include "voxel/float4.h"
#include "voxel/half.h"

namespace voxref {

/// How volumes of radiance and opacity hold their numbers.
enum class Storage : uint8_t {
  float32,
  float16,  ///< half floats: steps of 1/2048 of the value, radiance clamped to 65504
  unorm8    ///< bytes, [0,1] in steps of 1/255: what the published shaders use, and what clamps radiance above 1
};

/// As `storage` and volumes.json call them.
inline constexpr std::array<std::string_view, 3> storage_names = {"float32", "float16", "unorm8"};

/// A texel of four bytes. Absent texels are zero in every storage.
struct Rgba8 {
  std::array<uint8_t, 4> bytes{};
  bool operator==(const Rgba8&) const = default;
};

/// A texel of four half floats. Absent texels are zero.
struct Rgba16f {
  Half4 halves{};
  bool operator==(const Rgba16f&) const = default;
};

/// Calls visit(std::type_identity<Texel>{}) with the texel of a storage.
template <class Visit>
decltype(auto) with_texel(Storage storage, Visit&& visit) {
  switch (storage) {
    case Storage::float16:
      return visit(std::type_identity<Rgba16f>{});
    case Storage::unorm8:
      return visit(std::type_identity<Rgba8>{});
    default:
      return visit(std::type_identity<glm::vec4>{});
  }
}

/// A texel's value. A byte decodes by a multiplication, as GPUs do it: division differs in the last bit for half of all
/// bytes, which moves up to 9 % of the texels of filtered volumes by 1 (spec section 4).
inline Float4 decode(const glm::vec4& texel) { return load(texel); }
inline Float4 decode(const Rgba16f& texel) { return from_halves(texel.halves); }
/// The four bytes as numbers to 255.
inline Float4 decode_bytes(const Rgba8& texel) {
  int32_t packed;
  std::memcpy(&packed, texel.bytes.data(), sizeof packed);
  const __m128i zero = _mm_setzero_si128();
  const __m128i wide = _mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128(packed), zero), zero);
  return reinterpret_cast<Float4>(_mm_cvtepi32_ps(wide));
}
inline Float4 decode(const Rgba8& texel) { return decode_bytes(texel) * (1.0f / 255.0f); }

/// The fourth channel alone; the same bits.
inline float decode_alpha(const glm::vec4& texel) { return texel.a; }
inline float decode_alpha(const Rgba16f& texel) { return decode(texel)[3]; }
inline float decode_alpha(const Rgba8& texel) { return static_cast<float>(texel.bytes[3]) * (1.0f / 255.0f); }

/// The greatest value that each channel of a texel can hold.
template <class Texel>
inline constexpr float greatest = std::numeric_limits<float>::infinity();
template <>
inline constexpr float greatest<Rgba16f> = greatest_half;
template <>
inline constexpr float greatest<Rgba8> = 1.0f;

/// The texel that holds `value`: exactly, or rounded to the nearest half float or byte, ties to even, what is too large
/// clamped to the greatest (and below 0 to 0 in bytes). A NaN stays one; in unorm8 it becomes 0.
template <class Texel>
Texel encode(const Float4& value);
template <>
inline glm::vec4 encode<glm::vec4>(const Float4& value) {
  return to_vec4(value);
}
template <>
inline Rgba16f encode<Rgba16f>(const Float4& value) {
  // min and max return the second operand when either is NaN.
  const __m128 limit = _mm_set1_ps(greatest_half), least = _mm_set1_ps(-greatest_half);
  return {to_halves(reinterpret_cast<Float4>(_mm_max_ps(least, _mm_min_ps(limit, reinterpret_cast<__m128>(value)))))};
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

/// Radiance that is brought into a storage, and what did not fit: no clamping goes unseen.
struct Clamping {
  size_t voxels = 0;       ///< how many had a channel above the greatest
  float brightest = 0.0f;  ///< the largest of these channels, as it was

  /// What is read of a colour that was stored.
  template <class Texel>
  glm::vec3 store(const glm::vec3& color) {
    const float largest = std::max({color.r, color.g, color.b});
    if (largest > greatest<Texel>) {
      ++voxels;
      brightest = std::max(brightest, largest);
    }
    return glm::vec3(to_vec4(decode(encode<Texel>(load(glm::vec4(color, 1.0f))))));
  }
  Clamping& operator+=(const Clamping& other) {
    voxels += other.voxels;
    brightest = std::max(brightest, other.brightest);
    return *this;
  }
};

/// Six faces of one texel side by side (see Face).
template <class Texel>
using Directional = std::array<Texel, 6>;

}  // namespace voxref
