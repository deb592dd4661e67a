#include "study/deviation.h"

#include <algorithm>
#include <cmath>

namespace voxref {

double MeanSquare::root(double errors) const { return std::sqrt(std::max(0.0, value + errors * error)); }

MeanSquare mean_square(std::span<const double> differences, std::span<const double> variances) {
  const auto count = static_cast<double>(differences.size());
  double sum = 0.0, variance = 0.0, least = 0.0;
  for (size_t i = 0; i < differences.size(); ++i) {
    const double d2 = differences[i] * differences[i], v = variances[i];
    sum += d2 - v;
    variance += 4.0 * d2 * v - 2.0 * v * v;
    least += 2.0 * v * v;
  }
  return {sum / count, std::sqrt(std::max(least, variance)) / count};
}

Deviation deviation(const Measured& a, const Measured& b) {
  std::vector<double> differences(b.value.size()), variances(b.value.size());
  for (size_t i = 0; i < b.value.size(); ++i) {
    differences[i] = a.value[i] - b.value[i];
    variances[i] = a.standard_error[i] * a.standard_error[i] + b.standard_error[i] * b.standard_error[i];
  }
  const double mean = b.mean();
  const auto over = [](double value, double unit) { return value == 0.0 ? 0.0 : value / unit; };  // 0 of black is 0
  const MeanSquare square = mean_square(differences, variances);
  return {over(a.mean() - mean, mean), {over(square.value, mean * mean), over(square.error, mean * mean)}};
}

bool has_indirect_to_compare(const Scene& scene, const View& view, const Image& path) {
  return compares_indirect(scene, view) && measured_path(path, true).mean() > 0.0;
}

}  // namespace voxref
