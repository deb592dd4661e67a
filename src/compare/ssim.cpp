#include "compare/ssim.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "compare/convolve.h"

namespace voxref {

namespace {

constexpr int window_side = 11;
constexpr double window_sigma = 1.5;
constexpr double k1 = 0.01, k2 = 0.03;  // with dynamic range 1 the paper's C1 = k1^2 and C2 = k2^2

/// Gaussian taps of sum 1: 11, or the largest odd number that fits the side.
std::vector<double> window(int side) {
  const int radius = (std::min(window_side, side) - 1) / 2;
  std::vector<double> taps;
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) {
    taps.push_back(std::exp(-0.5 * i * i / (window_sigma * window_sigma)));
    sum += taps.back();
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

}  // namespace

double ssim(int width, int height, std::span<const float> a, std::span<const float> b) {
  assert(a.size() == b.size() && a.size() == static_cast<size_t>(width) * static_cast<size_t>(height));
  const std::vector<double> along_x = window(width), along_y = window(height);
  // Window means of a, b, a^2, b^2 and ab, in double: the variances are small differences of them.
  const auto mean_of = [&](auto&& value) {
    std::vector<double> plane(a.size());
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = value(double{a[i]}, double{b[i]});
    return convolve<double>(width, height, plane, along_x, along_y);
  };
  const std::vector<double> mean_a = mean_of([](double x, double) { return x; });
  const std::vector<double> mean_b = mean_of([](double, double y) { return y; });
  const std::vector<double> mean_aa = mean_of([](double x, double) { return x * x; });
  const std::vector<double> mean_bb = mean_of([](double, double y) { return y * y; });
  const std::vector<double> mean_ab = mean_of([](double x, double y) { return x * y; });

  const auto radius_x = static_cast<int>(along_x.size() / 2), radius_y = static_cast<int>(along_y.size() / 2);
  double sum = 0.0;
  for (int y = radius_y; y < height - radius_y; ++y)
    for (int x = radius_x; x < width - radius_x; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      const double variance_a = mean_aa[i] - mean_a[i] * mean_a[i], variance_b = mean_bb[i] - mean_b[i] * mean_b[i];
      const double covariance = mean_ab[i] - mean_a[i] * mean_b[i];
      const double luminance =
          (2.0 * mean_a[i] * mean_b[i] + k1 * k1) / (mean_a[i] * mean_a[i] + mean_b[i] * mean_b[i] + k1 * k1);
      const double contrast_structure = (2.0 * covariance + k2 * k2) / (variance_a + variance_b + k2 * k2);
      sum += luminance * contrast_structure;
    }
  const double windows = static_cast<double>(width - 2 * radius_x) * static_cast<double>(height - 2 * radius_y);
  return sum / windows;
}

}  // namespace voxref
