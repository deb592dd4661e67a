#pragma once
#include "cone/interpolate.h"
#include "cone/medium.h"

namespace voxref {

/// Look-up in a medium, trilinear in space, of one level. @param p voxels @return rgb: extinction x radiance, a:
/// extinction, 1/voxel
template <class Texel>
Float4 trilinear(const BasicMedium<Texel>& medium, const Float4& p, int level, const OpticalRead& read) {
  const auto of = [&](const auto& volume, const Float4& at) {
    const auto corners = corners_within(volume, at);
    return corners.empty ? Float4{} : interpolate(corners, read);
  };
  const float per_cell = 1.0f / BasicMedium<Texel>::cell(level);
  const Float4 depth =
      level == 0 ? of(medium.texels.base, p) : of(medium.texels.levels[static_cast<size_t>(level - 1)], p * per_cell);
  return (per_cell * optical_unit<Texel>)*depth;
}

/// Quadrilinear look-up: linear between the two levels around `level` too. @param level in [0, medium.top()]
template <class Texel>
Float4 quadrilinear(const BasicMedium<Texel>& medium, const Float4& p, float level, const OpticalRead& read) {
  const int lower = static_cast<int>(level);
  const float f = level - static_cast<float>(lower);
  const Float4 fine = trilinear(medium, p, lower, read);
  return f == 0.0f ? fine : mix(fine, trilinear(medium, p, lower + 1, read), f);
}

}  // namespace voxref
