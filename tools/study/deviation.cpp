#include "study/deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/path.h"

namespace voxref {

double MeanSquare::root(double errors) const {
  const double moved = value + errors * error;
  return moved < 0.0 ? 0.0 : std::sqrt(moved);  // std::max(0.0, NaN) would be 0, the best of all errors
}

MeanSquare mean_square(std::span<const double> differences, std::span<const double> variances, double freedom) {
  const auto count = static_cast<double>(differences.size());
  const double over_v2 = 3.0 / (freedom + 2.0);  // (f - 1) / (f + 2) and (f + 1) / (f + 2), also where f is infinite
  double sum = 0.0, variance = 0.0, least = 0.0;
  for (size_t i = 0; i < differences.size(); ++i) {
    const double d2 = differences[i] * differences[i], v = variances[i];
    sum += d2 - v;
    variance += 4.0 * d2 * v - 2.0 * (1.0 - over_v2) * v * v;
    least += 2.0 * (1.0 - over_v2 / 3.0) * v * v;
  }
  return {sum / count, std::sqrt(std::max(least, variance)) / count};
}

double relative(double value, double unit) { return value == 0.0 ? 0.0 : value / unit; }

Deviation deviation(const Measured& a, const Measured& b) {
  size_t nonfinite = 0;
  std::vector<double> differences(b.value.size()), variances(b.value.size());
  for (size_t i = 0; i < b.value.size(); ++i) {
    differences[i] = a.value[i] - b.value[i];
    variances[i] = a.standard_error[i] * a.standard_error[i] + b.standard_error[i] * b.standard_error[i];
    nonfinite += !std::isfinite(differences[i]) || !std::isfinite(variances[i]);
  }
  if (nonfinite > 0) {  // as Metrics: a mean over the other pixels would be an error of another image
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {nonfinite, none, {none, none}};
  }
  const double mean = b.mean();
  const MeanSquare square = mean_square(differences, variances, PathOptions().randomizations - 1.0);
  return {
      0, relative(a.mean() - mean, mean), {relative(square.value, mean * mean), relative(square.error, mean * mean)}};
}

}  // namespace voxref
