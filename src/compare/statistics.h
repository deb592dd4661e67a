#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

// What a comparison of random estimates needs to say: how sure a verdict is, and how small a bias it would have caught.
namespace voxref {

/// Regularized incomplete beta function I_x(p, q) by its continued fraction, DLMF 8.17.22, from its innermost term out.
/// It converges in about sqrt(max(p, q)) terms for x below (p + 1) / (p + q + 2); beyond, I_x(p, q) = 1 - I_(1-x)(q,
/// p).
inline double incomplete_beta(double x, double p, double q) {
  if (x <= 0.0 || x >= 1.0) return x <= 0.0 ? 0.0 : 1.0;
  if (x > (p + 1.0) / (p + q + 2.0)) return 1.0 - incomplete_beta(1.0 - x, q, p);
  double fraction = 1.0;
  for (int n = 50 + static_cast<int>(5.0 * std::sqrt(std::max(p, q))); n >= 1; --n) {
    const int half = n / 2;
    const double m = half;
    const double term = n % 2 ? -(p + m) * (p + q + m) * x / ((p + 2.0 * m) * (p + 2.0 * m + 1.0))
                              : m * (q - m) * x / ((p + 2.0 * m - 1.0) * (p + 2.0 * m));
    fraction = 1.0 + term / fraction;
  }
  const double log_front = p * std::log(x) + q * std::log1p(-x) + std::lgamma(p + q) - std::lgamma(p) - std::lgamma(q);
  return std::exp(log_front) / (p * fraction);
}

/// Two-sided tail of Student's distribution: probability that |T| exceeds |t|. @param freedom degrees, may be infinite
inline double student_tail(double t, double freedom) {
  // Abramowitz and Stegun 1964, 26.7.8: the normal deviate of the same tail; at t = 5 right to 0.1 % of the tail there.
  constexpr double nearly_normal = 1000.0;
  if (!(freedom < nearly_normal)) {
    const double spread = 1.0 / freedom;
    return std::erfc(std::abs(t) * (1.0 - 0.25 * spread) / std::sqrt(2.0 + t * t * spread));
  }
  return incomplete_beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5);
}

/// The t that |T| exceeds with probability `tail`. @param tail above 0, below 1
inline double student_quantile(double tail, double freedom) {
  double low = 0.0, high = 1.0;
  while (student_tail(high, freedom) > tail) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (student_tail(middle, freedom) > tail ? low : high) = middle;
  }
  return high;
}

/// NaN of no values.
inline double mean(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Several measurements of one thing.
struct Spread {
  double median = 0.0, least = 0.0, greatest = 0.0;
};

/// Of at least one value.
inline Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {median, values.front(), values.back()};
}

/// A mean and its standard error; freedom: degrees with which the error is itself known, infinite where it is exact.
struct Estimate {
  double mean = 0.0, error = 0.0;
  double freedom = std::numeric_limits<double>::infinity();
};

/// Of values that are independent of each other, at least two.
inline Estimate estimate(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  const double middle = mean(values);
  double scatter = 0.0;
  for (const double value : values) scatter += (value - middle) * (value - middle);
  return {middle, std::sqrt(scatter / (count * (count - 1.0))), count - 1.0};
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
