#pragma once
#include <limits>
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

/// Of differences d with independent, normally distributed noise whose variance is estimated as v with `freedom`
/// degrees of freedom f: mean(d^2 - v). With D and V the true difference and variance, d^2 - v has the variance
///
///   4 D^2 V + 2 V^2 + 2 V^2 / f,        E(4 d^2 v) = 4 D^2 V + 4 V^2,        E(v^2) = V^2 (f + 2) / f,
///
/// so 4 d^2 v - 2 (f - 1) / (f + 2) v^2 is an unbiased estimate of it, and 2 (f + 1) / (f + 2) v^2 of the least that it
/// can be, at D = 0. @param freedom infinite: the variances are known
MeanSquare mean_square(std::span<const double> differences, std::span<const double> variances,
                       double freedom = std::numeric_limits<double>::infinity());

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

/// 0 where both are black; infinite where b alone is. Standard errors count as path_trace's, of its usual number of
/// randomizations.
Deviation deviation(const Measured& a, const Measured& b);

}  // namespace voxref
