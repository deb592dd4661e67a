#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace voxref::testing {

using Pixels = std::vector<glm::vec3>;

// FLIP as its paper states it, pixel by pixel with two-dimensional kernels, in double: slow and plain.
struct FlipByDefinition {
  int side;
  const Pixels &reference, &test;
  static constexpr double ppd = 67.0, pi = 3.14159265358979323846;
  using Triple = std::array<double, 3>;

  /// Relative XYZ: divided by the white point, the row sums of the matrix.
  static Triple xyz(const Triple& rgb) {
    constexpr double m[3][3] = {
        {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
    Triple result;
    for (size_t r = 0; r < 3; ++r)
      result[r] = (m[r][0] * rgb[0] + m[r][1] * rgb[1] + m[r][2] * rgb[2]) / (m[r][0] + m[r][1] + m[r][2]);
    return result;
  }
  static Triple opponent(const Triple& rgb) {
    const Triple c = xyz(rgb);
    return {116 * c[1] - 16, 500 * (c[0] - c[1]), 200 * (c[1] - c[2])};
  }
  /// Inverse of `opponent` by solving the three linear equations (it is affine: take it apart at the unit vectors).
  static Triple rgb_of(const Triple& c) {
    const Triple o = opponent({0, 0, 0}), r = opponent({1, 0, 0}), g = opponent({0, 1, 0}), b = opponent({0, 0, 1});
    const glm::dmat3 columns(r[0] - o[0], r[1] - o[1], r[2] - o[2], g[0] - o[0], g[1] - o[1], g[2] - o[2], b[0] - o[0],
                             b[1] - o[1], b[2] - o[2]);
    const glm::dvec3 rgb = glm::inverse(columns) * glm::dvec3(c[0] - o[0], c[1] - o[1], c[2] - o[2]);
    return {std::clamp(rgb.x, 0.0, 1.0), std::clamp(rgb.y, 0.0, 1.0), std::clamp(rgb.z, 0.0, 1.0)};
  }
  static Triple hunt_lab(const Triple& rgb) {
    Triple f = xyz(rgb);
    for (double& v : f) v = v > 216.0 / 24389.0 ? std::cbrt(v) : (24389.0 / 27.0 * v + 16.0) / 116.0;
    const double lightness = 116 * f[1] - 16;
    return {lightness, 5 * lightness * (f[0] - f[1]), 2 * lightness * (f[1] - f[2])};
  }

  template <class Kernel, class Value>  // kernel(dx, dy) in pixels, value(pixel)
  double filtered(const Pixels& pixels, int x, int y, int radius, Kernel&& kernel, Value&& value) const {
    double positive = 0.0, negative = 0.0, sum_positive = 0.0, sum_negative = 0.0;
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) {
        const double weight = kernel(double(dx), double(dy));
        const glm::vec3& p =
            pixels[static_cast<size_t>(std::clamp(y + dy, 0, side - 1) * side + std::clamp(x + dx, 0, side - 1))];
        const double v = value(Triple{double{p.x}, double{p.y}, double{p.z}});
        (weight > 0 ? positive : negative) += std::abs(weight);
        (weight > 0 ? sum_positive : sum_negative) += weight * v;
      }
    return sum_positive / positive + (negative > 0 ? sum_negative / negative : 0.0);
  }

  Triple perceived(const Pixels& pixels, int x, int y) const {
    const auto channel = [&](size_t c, double a1, double b1, double a2, double b2) {
      const auto kernel = [=](double dx, double dy) {
        const double r2 = (dx * dx + dy * dy) / (ppd * ppd);
        return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * r2 / b1) +
               a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * r2 / b2);
      };
      return filtered(pixels, x, y, 10, kernel, [c](const Triple& rgb) { return opponent(rgb)[c]; });
    };
    return hunt_lab(
        rgb_of({channel(0, 1, 0.0047, 0, 1e-5), channel(1, 1, 0.0053, 0, 1e-5), channel(2, 34.1, 0.04, 13.5, 0.025)}));
  }

  std::array<double, 2> edge_and_point(const Pixels& pixels, int x, int y) const {
    const double s2 = std::pow(0.5 * 0.082 * ppd, 2);
    const auto response = [&](auto&& derivative) {
      const auto luminance = [](const Triple& rgb) { return xyz(rgb)[1]; };
      const auto gaussian = [s2](double dx, double dy) { return std::exp(-(dx * dx + dy * dy) / (2 * s2)); };
      return std::hypot(
          filtered(
              pixels, x, y, 9, [&](double dx, double dy) { return derivative(dx) * gaussian(dx, dy); }, luminance),
          filtered(
              pixels, x, y, 9, [&](double dx, double dy) { return derivative(dy) * gaussian(dx, dy); }, luminance));
    };
    return {response([](double d) { return -d; }), response([s2](double d) { return d * d / s2 - 1; })};
  }

  double at(int x, int y) const {
    const auto distance = [](const Triple& a, const Triple& b) {
      return std::pow(std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]), 0.7);
    };
    const double largest = distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), knee = 0.4 * largest;
    const double raw = distance(perceived(reference, x, y), perceived(test, x, y));
    const double color = raw < knee ? 0.95 * raw / knee : 0.95 + 0.05 * (raw - knee) / (largest - knee);
    const auto a = edge_and_point(reference, x, y), b = edge_and_point(test, x, y);
    const double feature = std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1])) / std::sqrt(2.0);
    return std::pow(color, 1 - std::sqrt(feature));
  }
};

}  // namespace voxref::testing
