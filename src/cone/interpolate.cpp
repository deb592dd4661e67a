#include "cone/interpolate.h"

#include <immintrin.h>

// GCC and Clang compile these functions for AVX2 whatever the rest is compiled for.
#define VOXREF_WIDE __attribute__((target("avx2,f16c")))

namespace voxref {
namespace {

template <class Packed, class Texel>
Packed packed(const Texel& texel) {
  static_assert(sizeof(Packed) == sizeof(Texel));
  Packed bits;
  std::memcpy(&bits, &texel, sizeof bits);
  return bits;
}

// Two neighbours along x in one register of eight floats.

VOXREF_WIDE inline __m256 decoded_pair(const glm::vec4& a, const glm::vec4& b) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(&a.x)), _mm_loadu_ps(&b.x), 1);
}
VOXREF_WIDE inline __m256 decoded_pair(const Rgba16f& a, const Rgba16f& b) {
  return _mm256_cvtph_ps(_mm_insert_epi64(_mm_cvtsi64_si128(packed<int64_t>(a)), packed<int64_t>(b), 1));
}
VOXREF_WIDE inline __m256 bytes_of_pair(const Rgba8& a, const Rgba8& b) {
  const __m128i pair = _mm_insert_epi32(_mm_cvtsi32_si128(packed<int32_t>(a)), packed<int32_t>(b), 1);
  return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(pair));
}

/// What a read makes of a pair; `scale` is still to be multiplied.
template <class Read, class Texel>
struct Pair {
  static constexpr float scale = 1.0f;
  VOXREF_WIDE static __m256 value(const Texel& a, const Texel& b) { return decoded_pair(a, b); }
};
template <>
struct Pair<SquaredRead, Rgba8> {
  static constexpr float scale = 1.0f / 255.0f;
  VOXREF_WIDE static __m256 value(const Rgba8& a, const Rgba8& b) { return bytes_of_pair(a, b); }
};
template <>
struct Pair<OpticalRead, Rgba8> {
  static constexpr float scale = 1.0f;
  VOXREF_WIDE static __m256 value(const Rgba8& a, const Rgba8& b) {
    const __m256 depths =
        _mm256_setr_m128(_mm_set1_ps(depth_per_byte[a.bytes[3]]), _mm_set1_ps(depth_per_byte[b.bytes[3]]));
    return _mm256_mul_ps(bytes_of_pair(a, b), depths);
  }
};

// sum over rows (y, z), faces and both x of w_row w_x w_face texel: the weights of the rows are shared by the three
// faces, those of the faces by the rows.
template <class Texel, class Read>
VOXREF_WIDE Float4 interpolate_wide(const Corners<Directional<Texel>>& corners, const Read& read) {
  const Float4& f = corners.f;
  const __m256 along_x = _mm256_setr_m128(_mm_set1_ps(1.0f - f[0]), _mm_set1_ps(f[0]));
  const float rows[4] = {(1.0f - f[1]) * (1.0f - f[2]), f[1] * (1.0f - f[2]), (1.0f - f[1]) * f[2], f[1] * f[2]};
  __m256 sums[3] = {_mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps()};
  for (size_t row = 0; row < 4; ++row) {
    const __m256 weights = _mm256_mul_ps(along_x, _mm256_set1_ps(rows[row]));
    const Directional<Texel>&a = *corners.texels[2 * row], &b = *corners.texels[2 * row + 1];
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t face = read.faces[axis];
      sums[axis] = _mm256_add_ps(sums[axis], _mm256_mul_ps(Pair<Read, Texel>::value(a[face], b[face]), weights));
    }
  }
  const __m256 scale = _mm256_set1_ps(Pair<Read, Texel>::scale);
  __m256 sum = _mm256_mul_ps(sums[0], _mm256_mul_ps(scale, _mm256_set1_ps(read.weights[0])));
  sum = _mm256_add_ps(sum, _mm256_mul_ps(sums[1], _mm256_mul_ps(scale, _mm256_set1_ps(read.weights[1]))));
  sum = _mm256_add_ps(sum, _mm256_mul_ps(sums[2], _mm256_mul_ps(scale, _mm256_set1_ps(read.weights[2]))));
  return reinterpret_cast<Float4>(_mm_add_ps(_mm256_castps256_ps128(sum), _mm256_extractf128_ps(sum, 1)));
}

const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("f16c");

}  // namespace

template <class Texel, class Read>
Float4 interpolate(const Corners<Directional<Texel>>& corners, const Read& read) {
  return wide ? interpolate_wide(corners, read) : interpolate_plainly(corners, read);
}

template Float4 interpolate(const Corners<Directional<glm::vec4>>&, const SquaredRead&);
template Float4 interpolate(const Corners<Directional<Rgba16f>>&, const SquaredRead&);
template Float4 interpolate(const Corners<Directional<Rgba8>>&, const SquaredRead&);
template Float4 interpolate(const Corners<Directional<glm::vec4>>&, const OpticalRead&);
template Float4 interpolate(const Corners<Directional<Rgba16f>>&, const OpticalRead&);
template Float4 interpolate(const Corners<Directional<Rgba8>>&, const OpticalRead&);

}  // namespace voxref
