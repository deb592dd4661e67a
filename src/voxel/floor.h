#pragma once
#include <emmintrin.h>

#include <glm/vec3.hpp>

#include "voxel/float4.h"

namespace voxref {

/// The fourth says nothing.
inline Int4 to_int4(const glm::ivec3& v) { return Int4{v.x, v.y, v.z, 0}; }
inline glm::ivec3 to_ivec3(const Int4& v) { return {v[0], v[1], v[2]}; }
inline Float4 to_float4(const glm::vec3& v) { return Float4{v.x, v.y, v.z, 0.0f}; }
inline Float4 to_float4(const Int4& v) {
  return reinterpret_cast<Float4>(_mm_cvtepi32_ps(reinterpret_cast<__m128i>(v)));
}

/// Towards zero.
inline Int4 truncated(const Float4& x) { return reinterpret_cast<Int4>(_mm_cvttps_epi32(reinterpret_cast<__m128>(x))); }
/// Largest integers not above x, for |x| < 2^31. std::floor is a library call where SSE4.1 is not assumed.
inline Int4 floor_to_int(const Float4& x) {
  const Int4 i = truncated(x);
  return i + (to_float4(i) > x);  // true is -1
}
inline int floor_to_int(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x);
}

inline Float4 clamp(const Float4& x, const Float4& low, const Float4& high) {
  return reinterpret_cast<Float4>(_mm_min_ps(_mm_max_ps(reinterpret_cast<__m128>(x), reinterpret_cast<__m128>(low)),
                                             reinterpret_cast<__m128>(high)));
}

}  // namespace voxref
