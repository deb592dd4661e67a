#include "cone/raw_lookup.h"

#include <immintrin.h>

namespace voxref {
namespace {

int32_t packed(const Rgba8& texel) {
  int32_t bits;
  std::memcpy(&bits, texel.bytes.data(), sizeof bits);
  return bits;
}

/// Two neighbours along x in one register of eight floats, times their weights.
__attribute__((target("avx2"))) __m256 weighted_pair(const Rgba8& a, const Rgba8& b, __m256 weights) {
  const __m128i pair = _mm_insert_epi32(_mm_cvtsi32_si128(packed(a)), packed(b), 1);
  return _mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(pair)), weights);
}

// sum over rows (y, z), faces and both x of w_row w_x w_face byte / 255: the weights of the rows are shared by the
// three faces, those of the faces by the rows.
__attribute__((target("avx2"))) Float4 interpolate_avx2(const Corners<Directional<Rgba8>>& corners,
                                                        const SquaredRead& read) {
  const glm::vec3& f = corners.f;
  const __m256 along_x = _mm256_setr_m128(_mm_set1_ps(1.0f - f.x), _mm_set1_ps(f.x));
  const float rows[4] = {(1.0f - f.y) * (1.0f - f.z), f.y * (1.0f - f.z), (1.0f - f.y) * f.z, f.y * f.z};
  __m256 sums[3] = {_mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps()};
  for (size_t row = 0; row < 4; ++row) {
    const __m256 weights = _mm256_mul_ps(along_x, _mm256_set1_ps(rows[row]));
    const Directional<Rgba8>&a = *corners.texels[2 * row], &b = *corners.texels[2 * row + 1];
    for (size_t axis = 0; axis < 3; ++axis)
      sums[axis] = _mm256_add_ps(sums[axis], weighted_pair(a[read.faces[axis]], b[read.faces[axis]], weights));
  }
  const __m256 scale = _mm256_set1_ps(1.0f / 255.0f);
  __m256 sum = _mm256_mul_ps(sums[0], _mm256_mul_ps(scale, _mm256_set1_ps(read.weights[0])));
  sum = _mm256_add_ps(sum, _mm256_mul_ps(sums[1], _mm256_mul_ps(scale, _mm256_set1_ps(read.weights[1]))));
  sum = _mm256_add_ps(sum, _mm256_mul_ps(sums[2], _mm256_mul_ps(scale, _mm256_set1_ps(read.weights[2]))));
  return reinterpret_cast<Float4>(_mm_add_ps(_mm256_castps256_ps128(sum), _mm256_extractf128_ps(sum, 1)));
}

}  // namespace

Float4 interpolate(const Corners<Directional<Rgba8>>& corners, const SquaredRead& read) {
  static const bool wide = __builtin_cpu_supports("avx2");
  return wide ? interpolate_avx2(corners, read) : interpolate<Directional<Rgba8>, SquaredRead>(corners, read);
}

}  // namespace voxref
