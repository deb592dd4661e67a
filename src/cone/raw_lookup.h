#pragma once
#include "cone/interpolate.h"
#include "cone/raw_march.h"

namespace voxref {

/// Trilinear look-up in a volume whose border texels go on for ever, 0 where nothing is stored.
template <class Texel, class Read>
Float4 trilinear_clamped(const BrickVolume<Texel>& volume, const Float4& p, const Read& read) {
  const Corners<Texel> corners = corners_clamped(volume, p);
  return corners.empty ? Float4{} : interpolate(corners, read);
}

/// A cone's sample. @param p in voxels of the base volume
template <class Texel>
Float4 sample_raw(const BasicPyramid<Texel>& pyramid, const Float4& p, const ConeStep& step, const SquaredRead& read) {
  const auto at = [&](int level) {
    if (level == 0) return trilinear_clamped(pyramid.base, p, read);
    return trilinear_clamped(pyramid.levels[size_t(level - 1)], p * (1.0f / float(1u << level)), read);
  };
  const Float4 fine = at(step.level);
  return step.fraction == 0.0f ? fine : mix(fine, at(step.level + 1), step.fraction);
}

}  // namespace voxref
