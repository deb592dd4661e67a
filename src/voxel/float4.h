#pragma once
#include <cstdint>
#include <cstring>
#include <glm/vec4.hpp>

namespace voxref {

/// Four floats in one register: a texel. The vector extension that GCC and Clang share; every operation is element by
/// element, so that results are those of plain floats.
using Float4 = float __attribute__((vector_size(16)));

/// Three or four integers in one register.
using Int4 = int32_t __attribute__((vector_size(16)));

/// Eight side by side: of two texels, or one number of eight samples. Functions take them by reference, since how they
/// are passed by value depends on the instruction set.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int32_t __attribute__((vector_size(32)));

inline Float4 load(const glm::vec4& v) {
  Float4 r;
  std::memcpy(&r, &v, sizeof r);  // compiles to one unaligned load
  return r;
}
inline glm::vec4 to_vec4(const Float4& v) { return {v[0], v[1], v[2], v[3]}; }
inline Float4 mix(const Float4& a, const Float4& b, float t) { return a + t * (b - a); }

}  // namespace voxref
