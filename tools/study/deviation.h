#pragma once
#include <span>

#include "compare/measured.h"

namespace voxref {

/// Mean over pixels of the squares of differences that are known up to noise, with the noise taken out.
struct MeanSquare {
  double value = 0;  ///< unbiased, and therefore below 0 at times where there is little but noise
  double error = 0;  ///< its standard error
  /// Square root of the value moved by so many standard errors; 0 where that is negative, NaN where either is.
  double root(double errors = 0.0) const;
  /// Half of what one standard error to either side spans in the root.
  double root_stderr() const { return 0.5 * (root(1.0) - root(-1.0)); }
};

/// Of differences d with independent noise of variance v each: mean(d^2 - v). Noise gives d^2 the variance
/// 4 D^2 v + 2 v^2, D being the true difference, of which 4 d^2 v - 2 v^2 is an unbiased estimate,
/// and 2 v^2 the least that it can be.
MeanSquare mean_square(std::span<const double> differences, std::span<const double> variances);

/// value / unit, but 0 of 0 is 0: black against black is no error.
double relative(double value, double unit);

/// How far one image is from another that is taken for true.
struct Deviation {
  size_t nonfinite = 0;  ///< pixels in which either image is NaN or infinite; the rest is NaN where there are any
  double bias = 0;       ///< mean(a) / mean(b) - 1
  MeanSquare square;     ///< of (a - b) / mean(b), the noise of both taken out
  /// rel_error of cli.md.
  double rel_error() const { return square.root(); }
  double rel_error_stderr() const { return square.root_stderr(); }
};

/// 0 where both are black; infinite where b alone is.
Deviation deviation(const Measured& a, const Measured& b);

}  // namespace voxref
