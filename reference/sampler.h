#pragma once
#include <cstdint>
#include <glm/vec2.hpp>

namespace voxref {

// Sample points: padded two-dimensional Owen-scrambled Sobol points (Burley 2020, "Practical Hash-based Owen
// Scrambling").
//
// A *randomization* is one independent scramble of the Sobol sequence. It is named by a key, made of the seed, the
// pixel and a number; its points 0, 1, 2, ... are stratified among each other and independent of every other
// randomization's. Within it, each dimension set (a number or a pair of numbers) has its own scramble and its own order
// of the points, so that sets do not correlate; the order is itself an Owen scramble of the point's index, which keeps
// every aligned block of 2^k points an elementary net.

/// Mixes all 64 bits: the finalizer of SplitMix64 (Steele, Lea and Flood 2014, variant 13 of Stafford's).
inline uint64_t mix_bits(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

inline uint32_t reverse_bits(uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// Owen's nested uniform scramble in base 2 of a number whose bits are reversed: a bit is flipped depending on the bits
/// below it alone (Laine and Karras 2011, constants of Burley 2020).
inline uint32_t scramble_reversed(uint32_t x, uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

/// The second Sobol coordinate of point `index`, bits reversed. Its generator matrix is Pascal's triangle modulo 2, and
/// C(j,i) is odd where the bits of i are among those of j (Lucas), so bit i of the result is the parity of the index
/// bits at all supersets j of i: a sum over supersets, one halving per bit of the position.
inline uint32_t sobol_second_reversed(uint32_t index) {
  index ^= (index >> 16) & 0x0000ffffu;
  index ^= (index >> 8) & 0x00ff00ffu;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 2) & 0x33333333u;
  return index ^ ((index >> 1) & 0x55555555u);
}

/// The upper 24 bits as a float in [0,1), every value exact.
inline float unit_float(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }
inline glm::vec2 unit_floats(const glm::uvec2& bits) { return {unit_float(bits.x), unit_float(bits.y)}; }

/// The key of randomization `number` of pixel (x,y). Keys do not depend on the image's size.
inline uint64_t randomization_key(uint64_t seed, uint32_t x, uint32_t y, uint32_t number) {
  return mix_bits(mix_bits(mix_bits(seed) + ((uint64_t{y} << 32) | x)) + number);
}

/// One point of a randomization. Any dimension may be asked for, in any order.
class Sampler {
 public:
  /// @param index the point's number in the randomization
  Sampler(uint64_t key, uint32_t index) : key_(key), reversed_index_(reverse_bits(index)) {}

  /// All 32 bits of a one-dimensional set, for choices among many.
  uint32_t bits_1d(uint32_t dimension) const { return bits_1d(key_, reversed_index_, dimension); }
  float get_1d(uint32_t dimension) const { return unit_float(bits_1d(dimension)); }  ///< in [0,1)

  /// All 32 bits of both numbers of a two-dimensional set.
  glm::uvec2 bits_2d(uint32_t dimension) const { return bits_2d(key_, reversed_index_, dimension); }
  /// The same as numbers in [0,1).
  glm::vec2 get_2d(uint32_t dimension) const { return unit_floats(bits_2d(dimension)); }

  // What a sampler is made of, for those who work on many at once (SamplerBlock).
  uint64_t key() const { return key_; }
  uint32_t reversed_index() const { return reversed_index_; }
  static uint32_t bits_1d(uint64_t key, uint32_t reversed_index, uint32_t dimension) {
    const uint64_t seeds = dimension_seeds(key, dimension);
    return reverse_bits(scramble_reversed(shuffled_index(reversed_index, seeds), static_cast<uint32_t>(seeds >> 32)));
  }
  static glm::uvec2 bits_2d(uint64_t key, uint32_t reversed_index, uint32_t dimension) {
    const uint64_t seeds = dimension_seeds(key, dimension);
    const uint32_t index = shuffled_index(reversed_index, seeds);
    const uint32_t x = scramble_reversed(index, static_cast<uint32_t>(seeds >> 32));
    // A third seed from the two: the upper half of a product depends on all bits of both.
    const uint64_t second_seeds = (seeds | 1) * 0x9e3779b97f4a7c15u;
    const uint32_t y = scramble_reversed(sobol_second_reversed(index), static_cast<uint32_t>(second_seeds >> 32));
    return {reverse_bits(x), reverse_bits(y)};
  }

 private:
  static uint64_t dimension_seeds(uint64_t key, uint32_t dimension) {
    return mix_bits(key + dimension * 0x9e3779b97f4a7c15u);
  }
  static uint32_t shuffled_index(uint32_t reversed_index, uint64_t seeds) {
    return reverse_bits(scramble_reversed(reversed_index, static_cast<uint32_t>(seeds)));
  }

  uint64_t key_;
  uint32_t reversed_index_;
};

}  // namespace voxref
