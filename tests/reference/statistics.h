#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>

// What the tests of random estimates need to say: how sure a verdict is, and how small a bias it would have caught.
namespace voxref {

/// Two-sided tail of Student's distribution: probability that |T| exceeds |t|. @param freedom degrees, may be infinite
inline double student_tail(double t, double freedom) {
  t = std::abs(t);
  if (!(freedom < 1e7)) return std::erfc(t / std::numbers::sqrt2);
  const double log_scale =
      std::lgamma(0.5 * (freedom + 1.0)) - std::lgamma(0.5 * freedom) - 0.5 * std::log(freedom * std::numbers::pi);
  const auto density = [&](double x) {
    return std::exp(log_scale - 0.5 * (freedom + 1.0) * std::log1p(x * x / freedom));
  };
  // Simpson's rule over the body; what it leaves of 1 is right to about 1e-9, enough for any significance in use.
  constexpr int intervals = 2000;
  double body = density(0.0) + density(t);
  for (int i = 1; i < intervals; ++i) body += (i % 2 ? 4.0 : 2.0) * density(t * i / intervals);
  return std::max(0.0, 1.0 - 2.0 * body * t / (3.0 * intervals));
}

/// The t that |T| exceeds with probability `tail`. @param tail in (1e-8, 1)
inline double student_quantile(double tail, double freedom) {
  double low = 0.0, high = 1.0;
  while (student_tail(high, freedom) > tail) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (student_tail(middle, freedom) > tail ? low : high) = middle;
  }
  return high;
}

/// A mean and its standard error; freedom: degrees with which the error is itself known, infinite where it is exact.
struct Estimate {
  double mean = 0.0, error = 0.0;
  double freedom = std::numeric_limits<double>::infinity();
};

/// Of values that are independent of each other, at least two.
inline Estimate estimate(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  double mean = 0.0, scatter = 0.0;
  for (const double value : values) mean += value / count;
  for (const double value : values) scatter += (value - mean) * (value - mean);
  return {mean, std::sqrt(scatter / (count * (count - 1.0))), count - 1.0};
}

/// Welch's test of two means with errors of their own (Welch 1947); freedom after Satterthwaite 1946.
struct Welch {
  Welch(const Estimate& a, const Estimate& b)
      : difference(a.mean - b.mean), error(std::hypot(a.error, b.error)), freedom(std::pow(error, 4.0)) {
    const auto share = [](const Estimate& e) { return std::pow(e.error, 4.0) / e.freedom; };
    freedom = share(a) + share(b) > 0.0 ? freedom / (share(a) + share(b)) : std::numeric_limits<double>::infinity();
  }
  /// Probability of a difference at least as large where the true means agree.
  double p() const { return student_tail(difference / error, freedom); }
  /// The smallest true difference that p() < significance would reveal with the probability `power`, above a half.
  double detectable(double significance, double power = 0.9) const {
    return (student_quantile(significance, freedom) + student_quantile(2.0 * (1.0 - power), freedom)) * error;
  }

  double difference, error, freedom;
};

/// Limits that the mean of squares of `count` independent values of Student's distribution keeps to within `sigmas`
/// standard errors. Its square has the mean v / (v - 2) and the fourth moment 3 v^2 / ((v - 2)(v - 4)).
struct SquareLimits {
  SquareLimits(double freedom, double count, double sigmas)
      : expected(freedom / (freedom - 2.0)),
        margin(
            sigmas *
            std::sqrt((3.0 * freedom * freedom / ((freedom - 2.0) * (freedom - 4.0)) - expected * expected) / count)) {}
  bool contain(double mean_square) const { return std::abs(mean_square - expected) < margin; }

  double expected, margin;
};

}  // namespace voxref
