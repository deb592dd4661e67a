#pragma once
#include <immintrin.h>

#include <type_traits>

#include "cone/interpolate.h"

// What marches call most is compiled twice: for any machine, and for those with AVX2, fused multiplication and
// addition, and half floats in hardware. GCC and Clang compile marked functions for these whatever the rest is compiled
// for.
#define VOXREF_WIDE __attribute__((target("avx2,fma,f16c")))
/// Of the function that all the others are to be compiled into.
#define VOXREF_WIDE_ALL __attribute__((target("avx2,fma,f16c"), flatten))

namespace voxref {

/// Whether this machine can call what is marked so.
inline const bool wide_machine =
    __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");  // half floats are older

namespace wide_detail {

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
VOXREF_WIDE inline __m256 decoded_pair(const Rgba8& a, const Rgba8& b) {
  const __m128i pair = _mm_insert_epi32(_mm_cvtsi32_si128(packed<int32_t>(a)), packed<int32_t>(b), 1);
  return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(pair));
}

/// What a read makes of a pair.
template <class Read, class Texel>
VOXREF_WIDE inline __m256 value_of_pair(const Texel& a, const Texel& b) {
  if constexpr (std::is_same_v<Read, OpticalRead> && std::is_same_v<Texel, Rgba8>)
    return _mm256_mul_ps(decoded_pair(a, b), _mm256_setr_m128(_mm_set1_ps(depth_per_byte[a.bytes[3]]),
                                                              _mm_set1_ps(depth_per_byte[b.bytes[3]])));
  else
    return decoded_pair(a, b);
}

template <class Texel>
inline constexpr bool is_directional = false;
template <class Texel>
inline constexpr bool is_directional<Directional<Texel>> = true;

/// Both halves of a register.
VOXREF_WIDE inline Float4 halves_added(const __m256& sum) {
  return reinterpret_cast<Float4>(_mm_add_ps(_mm256_castps256_ps128(sum), _mm256_extractf128_ps(sum, 1)));
}

}  // namespace wide_detail

/// A sum of look-ups in volumes of directional bytes. What they have in common is done once: to choose the faces and to
/// weight them.
class ByteSum {
 public:
  VOXREF_WIDE explicit ByteSum(const SquaredRead& read) {
    constexpr char none = -128;  // becomes 0
    const __m256i spread = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(0, none, none, none, 1, none, none, none, 2, none, none, none, 3, none, none, none));
    // A texel's faces towards x and y are spread out by one shuffle of its first 16 bytes, those towards z of two
    // texels by one of their last eight.
    choose_xy_ = _mm256_add_epi8(spread, halves_of(4 * read.faces[0], 4 * read.faces[1]));
    choose_z_ = _mm256_add_epi8(spread, halves_of(4 * read.faces[2] - 16, 4 * read.faces[2] - 8));
    weights_xy_ = _mm256_setr_m128(_mm_set1_ps(read.weights[0]), _mm_set1_ps(read.weights[1]));
    weight_z_ = _mm256_set1_ps(read.weights[2]);
  }

  template <class SomeCorners, class Shares>
  VOXREF_WIDE void add(const SomeCorners& corners, const Shares& shares) {
    for (size_t row = 0; row < 4; ++row) {
      const auto *a = &corners[2 * row], *b = &corners[2 * row + 1];
      const __m256 low = _mm256_set1_ps(shares[2 * row]), high = _mm256_set1_ps(shares[2 * row + 1]);
      sum_xy_ = _mm256_fmadd_ps(shuffled(both(load_128(a)), choose_xy_), low, sum_xy_);
      sum_xy_ = _mm256_fmadd_ps(shuffled(both(load_128(b)), choose_xy_), high, sum_xy_);
      sum_z_ =
          _mm256_fmadd_ps(shuffled(last_of<SomeCorners>(a, b), choose_z_), _mm256_blend_ps(low, high, 0xf0), sum_z_);
    }
  }
  VOXREF_WIDE Float4 total() const {
    const __m256 sum = _mm256_fmadd_ps(sum_xy_, weights_xy_, _mm256_mul_ps(sum_z_, weight_z_));
    return wide_detail::halves_added(sum) * (1.0f / 255.0f);
  }

 private:
  /// Bytes of a register, those of each half alike.
  VOXREF_WIDE static __m256i halves_of(size_t low, size_t high) {
    return _mm256_setr_m128i(_mm_set1_epi8(char(low)), _mm_set1_epi8(char(high)));
  }
  VOXREF_WIDE static __m128i load_128(const void* from) { return _mm_loadu_si128(static_cast<const __m128i*>(from)); }
  VOXREF_WIDE static __m256i both(const __m128i& half) { return _mm256_broadcastsi128_si256(half); }
  VOXREF_WIDE static __m256 shuffled(const __m256i& bytes, const __m256i& order) {
    return _mm256_cvtepi32_ps(_mm256_shuffle_epi8(bytes, order));
  }
  /// The last eight bytes of `a` from the lower half's beginning on, those of `b` from the middle of the upper half on.
  template <class SomeCorners>
  VOXREF_WIDE static __m256i last_of(const Directional<Rgba8>* a, const Directional<Rgba8>* b) {
    const auto* last_of_a = &(*a)[4];
    if constexpr (SomeCorners::rows_together) return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(last_of_a));
    const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(last_of_a));
    return both(_mm_unpacklo_epi64(low, _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&(*b)[4]))));
  }

  __m256i choose_xy_, choose_z_;
  __m256 weights_xy_, weight_z_;
  __m256 sum_xy_ = _mm256_setzero_ps(), sum_z_ = _mm256_setzero_ps();
};

/// The same two texels at a time: the results differ by rounding.
struct WideKernel {
  /// As PlainKernel::Sum.
  template <class Texel, class Read>
  using Sum = std::conditional_t<std::is_same_v<Texel, Rgba8> && std::is_same_v<Read, SquaredRead>, ByteSum,
                                 LookupSum<WideKernel, Read>>;

  template <class SomeCorners, class Shares, class Read>
  VOXREF_WIDE static Float4 interpolate(const SomeCorners& corners, const Shares& shares, const Read& read) {
    using Texel = typename SomeCorners::Texel;
    if constexpr (std::is_same_v<Texel, Directional<Rgba8>> && std::is_same_v<Read, SquaredRead>) {
      ByteSum sum(read);
      sum.add(corners, shares);
      return sum.total();
    } else if constexpr (wide_detail::is_directional<Texel>) {
      return interpolate_pairs(corners, shares, read);
    } else {
      return PlainKernel::interpolate(corners, shares, read);
    }
  }

 private:
  template <class SomeCorners, class Shares, class Read>
  VOXREF_WIDE static Float4 interpolate_pairs(const SomeCorners& corners, const Shares& shares, const Read& read) {
    using namespace wide_detail;
    __m256 sums[3] = {_mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps()};
    for (size_t row = 0; row < 4; ++row) {
      const __m256 share = _mm256_setr_m128(_mm_set1_ps(shares[2 * row]), _mm_set1_ps(shares[2 * row + 1]));
      const auto &a = corners[2 * row], &b = corners[2 * row + 1];
      for (size_t axis = 0; axis < 3; ++axis) {
        const size_t face = read.faces[axis];
        sums[axis] = _mm256_fmadd_ps(value_of_pair<Read>(a[face], b[face]), share, sums[axis]);
      }
    }
    __m256 sum = _mm256_mul_ps(sums[0], _mm256_set1_ps(read.weights[0]));
    sum = _mm256_fmadd_ps(sums[1], _mm256_set1_ps(read.weights[1]), sum);
    sum = _mm256_fmadd_ps(sums[2], _mm256_set1_ps(read.weights[2]), sum);
    return halves_added(sum);
  }
};

}  // namespace voxref
