#pragma once
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace voxref {

/// Pearson's chi-square test of counts against expected counts. @returns the probability of a deviation at least as
/// large if the expectation is right. Bins that expect fewer than 5 are pooled, so that the statistic follows its
/// distribution.
inline double chi_square_p(std::span<const double> observed, std::span<const double> expected) {
  double statistic = 0.0, pooled_observed = 0.0, pooled_expected = 0.0;
  int bins = 0;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] < 5.0) {
      pooled_observed += observed[i];
      pooled_expected += expected[i];
      continue;
    }
    statistic += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
    ++bins;
  }
  if (pooled_expected >= 5.0) {
    statistic += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
    ++bins;
  }
  // Wilson and Hilferty 1931: the cube root of chi-square over its degrees of freedom is close to normal.
  const double freedom = bins - 1;
  const double spread = 2.0 / (9.0 * freedom);
  const double z = (std::cbrt(statistic / freedom) - (1.0 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

}  // namespace voxref
