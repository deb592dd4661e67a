#pragma once
#include "cone/interpolate.h"
#include "cone/medium.h"

namespace voxref {

/// Look-up in a medium, trilinear in space, of one level. @param p voxels @return rgb: extinction x radiance, a:
/// extinction, 1/voxel
template <class Kernel = PlainKernel, class Texel>
inline Float4 trilinear(const BasicMedium<Texel>& medium, const Float4& p, int level, const OpticalRead& read) {
  const auto of = [&](const auto& volume, const Float4& at) {
    return visit_corners_within(volume, at, [&](const auto& corners, const Float4& f) {
      return Kernel::interpolate(corners, corner_shares(f), read);
    });
  };
  const float per_cell = 1.0f / BasicMedium<Texel>::cell(level);
  const Float4 depth =
      level == 0 ? of(medium.texels.base, p) : of(medium.texels.levels[static_cast<size_t>(level - 1)], p * per_cell);
  return (per_cell * optical_unit<Texel>)*depth;
}

/// Quadrilinear look-up: linear between the two levels around `level` too. @param level in [0, medium.top()]
template <class Kernel = PlainKernel, class Texel>
inline Float4 quadrilinear(const BasicMedium<Texel>& medium, const Float4& p, float level, const OpticalRead& read) {
  const int lower = static_cast<int>(level);
  const float f = level - static_cast<float>(lower);
  const Float4 fine = trilinear<Kernel>(medium, p, lower, read);
  return f == 0.0f ? fine : mix(fine, trilinear<Kernel>(medium, p, lower + 1, read), f);
}

}  // namespace voxref
