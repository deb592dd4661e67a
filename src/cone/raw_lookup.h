#pragma once
#include "cone/interpolate.h"
#include "cone/raw_march.h"
#include "cone/texel_lanes.h"

namespace voxref {

/// Where eight samples of a cone, side by side, are looked up.
struct RawSamples {
  TexelLanes coarser, finer;  ///< in their coarsest level, and in the one below it; the shares of both sum to 1

  /// @param last texel of the base along each axis @param coarsest ConeStep::coarsest() @param coarser_share what
  /// the coarsest level counts @param x, y, z voxels
  RawSamples(const Int4& last, const Int8& coarsest, const Float8& coarser_share, const Float8& x, const Float8& y,
             const Float8& z) {
    locate_clamped(last, coarsest, x, y, z, coarser_share, coarser);
    locate_clamped(last, coarsest > 0 ? coarsest - 1 : coarsest, x, y, z, 1.0f - coarser_share, finer);
  }
};

/// One of them. Borders of volumes go on for ever; where nothing is stored there is 0.
template <class Kernel, class Texel>
inline Float4 sample_raw(const BasicPyramid<Texel>& pyramid, const RawSamples& samples, size_t lane,
                         const ConeStep& step, const SquaredRead& read) {
  const auto base = [&](const TexelLanes& lanes) {
    return visit_lane(pyramid.base, lanes, lane, [&](const auto& corners, const auto& shares) {
      return Kernel::interpolate(corners, shares, read);
    });
  };
  const int coarsest = step.coarsest();
  if (coarsest == 0) return base(samples.coarser);
  typename Kernel::template Sum<Texel, SquaredRead> sum(read);
  const auto add = [&](int level, const TexelLanes& lanes) {
    visit_lane(pyramid.levels[size_t(level - 1)], lanes, lane,
               [&](const auto& corners, const auto& shares) { sum.add(corners, shares); });
  };
  add(coarsest, samples.coarser);
  if (step.fraction == 0.0f) return sum.total();
  if (coarsest == 1) return base(samples.finer) + sum.total();
  add(coarsest - 1, samples.finer);
  return sum.total();
}

/// Opacity alone, of a step that reads the base alone.
template <class Texel>
inline float base_alpha(const BasicPyramid<Texel>& pyramid, const RawSamples& samples, size_t lane) {
  return visit_lane(pyramid.base, samples.coarser, lane, [](const auto& corners, const auto& shares) {
    float sum = 0.0f;
    for (size_t i = 0; i < 8; ++i) sum += shares[i] * decode_alpha(corners[i]);
    return sum;
  });
}

}  // namespace voxref
