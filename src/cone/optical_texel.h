#pragma once
#include <array>
#include <cmath>

#include "voxel/texel.h"

namespace voxref {

/// No finite extinction is opaque: opacity is held below 1 by this much, so that an opaque texel transmits as much.
inline constexpr float transparency_floor = 1e-4f;

/// -ln(1 - opacity), at most -ln(transparency_floor); a NaN stays one.
inline float optical_depth(float opacity) { return -std::log1p(-std::min(opacity, 1.0f - transparency_floor)); }

// A texel of a medium stands for (depth x radiance, depth): its optical depth from side to side, and what it emits.
// Floats hold these four numbers. Half floats hold a sixteenth of them, since a depth is below 16 and radiance may need
// all of their range. Bytes hold premultiplied radiance and opacity as they did before: of depths, which rise from 5.5
// to 9.2 with the last of 255 steps of opacity, they would have no fine ones left for what is nearly clear.

template <class Texel>
inline constexpr float optical_unit = 1.0f;  ///< optical(texel) times this is what the texel stands for
template <>
inline constexpr float optical_unit<Rgba16f> = 16.0f;

/// Depth over opacity of each byte of opacity, times the 1/255 that decodes bytes.
inline const std::array<float, 256> depth_per_byte = [] {
  std::array<float, 256> table{};
  for (size_t b = 1; b < table.size(); ++b) table[b] = optical_depth(float(b) / 255.0f) / float(b);
  return table;
}();

/// What a medium's texel stands for, over optical_unit. @return rgb: depth x radiance, a: depth
inline Float4 optical(const glm::vec4& texel) { return decode(texel); }
inline Float4 optical(const Rgba16f& texel) { return decode(texel); }
inline Float4 optical(const Rgba8& texel) { return decode_bytes(texel) * depth_per_byte[texel.bytes[3]]; }

/// A medium's texel. @param lit premultiplied radiance and opacity, as Pyramid holds them; not opaque: without colour
/// @param depth to hold in place of that opacity's own
template <class Texel>
Texel optical_texel(const glm::vec4& lit, float depth) {
  if (lit.a == 0.0f) return Texel{};
  return encode<Texel>(load(glm::vec4(glm::vec3(lit) * (depth / lit.a), depth) / optical_unit<Texel>));
}
template <>
inline Rgba8 optical_texel<Rgba8>(const glm::vec4& lit, float depth) {
  if (lit.a == 0.0f) return {};
  const float opacity = depth == optical_depth(lit.a) ? lit.a : -std::expm1(-depth);
  return encode<Rgba8>(load(glm::vec4(glm::vec3(lit) * (opacity / lit.a), opacity)));
}

}  // namespace voxref
