#include "compare/flip.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <random>
#include <vector>

#include "catch.h"
#include "parallel.h"

using voxref::flip_map;
using Pixels = std::vector<glm::vec3>;

namespace {

Pixels random_pixels(size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Pixels pixels(count);
  for (glm::vec3& pixel : pixels) pixel = {uniform(generator), uniform(generator), uniform(generator)};
  return pixels;
}

float middle(const std::vector<float>& map) { return map[map.size() / 2]; }

/// Two flat pictures: no blur and no features matter, only the colour distance.
float flat(const glm::vec3& a, const glm::vec3& b) { return middle(flip_map(9, 9, Pixels(81, a), Pixels(81, b))); }

/// Colour distance of greys a and b, in closed form: HyAB is the difference of L*, compressed as in the paper's
/// section 4.1 with the largest distance, that of pure green and pure blue (L*a*b* of sRGB primaries, after the Hunt
/// effect).
double grey_distance(double lightness_a, double lightness_b) {
  const double green_l = 87.7347, green_a = -86.1827, green_b = 83.1793, blue_l = 32.2970, blue_a = 79.1875,
               blue_b = -107.8602;
  const double largest = std::abs(green_l - blue_l) + std::hypot(0.01 * (green_l * green_a - blue_l * blue_a),
                                                                 0.01 * (green_l * green_b - blue_l * blue_b));
  const double distance = std::pow(std::abs(lightness_a - lightness_b), 0.7), top = std::pow(largest, 0.7),
               knee = 0.4 * top;
  return distance < knee ? 0.95 * distance / knee : 0.95 + 0.05 * (distance - knee) / (top - knee);
}

// FLIP as its paper states it, pixel by pixel with two-dimensional kernels, in double: slow and plain.
struct ByDefinition {
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

}  // namespace

TEST_CASE("FLIP of equal pictures is zero", "[compare]") {
  const Pixels pixels = random_pixels(32 * 32, 1);
  const std::vector<float> map = flip_map(32, 32, pixels, pixels);
  CHECK(*std::max_element(map.begin(), map.end()) == 0.0f);
}

TEST_CASE("FLIP of flat greys is the closed form of its colour distance", "[compare]") {
  // 1e-3: the published L*a*b* of the primaries are for a white point rounded in the fourth digit, and floats.
  CHECK(flat(glm::vec3(0.0f), glm::vec3(1.0f)) == Approx(grey_distance(0.0, 100.0)).epsilon(1e-3));
  CHECK(flat(glm::vec3(0.0f), glm::vec3(1.0f)) == Approx(0.967).margin(1e-3));
  // Luminance 0.18418651851244416 has L* = 50 exactly: ((50 + 16) / 116)^3.
  CHECK(flat(glm::vec3(0.184186519f), glm::vec3(1.0f)) == Approx(grey_distance(50.0, 100.0)).epsilon(1e-3));
  CHECK(flat({0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}) ==
        Approx(1.0).epsilon(1e-5));  // the largest of all, by definition
}

TEST_CASE("FLIP agrees with its definition computed pixel by pixel", "[compare]") {
  const int side = 24;
  // Blocks of four pixels: colours that survive the blur, so that every part of the pipeline counts.
  const Pixels colors_a = random_pixels(36, 8), colors_b = random_pixels(36, 9);
  Pixels a(side * side), b(side * side);
  for (size_t i = 0; i < a.size(); ++i) {
    a[i] = colors_a[i / side / 4 * 6 + i % side / 4];
    b[i] = colors_b[i / side / 4 * 6 + i % side / 4];
  }
  const std::vector<float> map = flip_map(side, side, a, b);
  double largest = 0.0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      largest = std::max(largest,
                         std::abs(ByDefinition{side, a, b}.at(x, y) - double{map[static_cast<size_t>(y * side + x)]}));
  CHECK(largest < 5e-4);  // the matrix of the definition has another rounding of the primaries in the fifth digit
}

TEST_CASE("FLIP is symmetric, stays in [0,1] and commutes with turning the picture", "[compare]") {
  const int side = 40;
  const Pixels a = random_pixels(side * side, 2), b = random_pixels(side * side, 3);
  const std::vector<float> map = flip_map(side, side, a, b);
  CHECK(map == flip_map(side, side, b, a));
  CHECK(*std::min_element(map.begin(), map.end()) >= 0.0f);
  CHECK(*std::max_element(map.begin(), map.end()) <= 1.0f);

  const auto turned = [&](const auto& pixels) {
    auto result = pixels;
    for (size_t y = 0; y < side; ++y)
      for (size_t x = 0; x < side; ++x) result[x * side + y] = pixels[y * side + x];
    return result;
  };
  const std::vector<float> map_of_turned = flip_map(side, side, turned(a), turned(b)), turned_map = turned(map);
  float largest = 0.0f;
  for (size_t i = 0; i < map.size(); ++i) largest = std::max(largest, std::abs(map_of_turned[i] - turned_map[i]));
  CHECK(largest < 1e-4f);  // rows and columns are summed in another order: float rounding, raised to 0.7 and 0.5
}

TEST_CASE("FLIP sees a large feature more than a small one and forgives what is too fine to see", "[compare]") {
  const int side = 64;
  Pixels grey(side * side, glm::vec3(0.3f)), checker = grey, block = grey;
  for (size_t y = 0; y < side; ++y)
    for (size_t x = 0; x < side; ++x) {
      checker[y * side + x] = glm::vec3((x + y) % 2 ? 0.4f : 0.2f);
      block[y * side + x] = glm::vec3(x < side / 2 ? 0.4f : 0.2f);
    }
  const auto mean = [](const std::vector<float>& map) {
    double sum = 0.0;
    for (const float value : map) sum += double{value};
    return sum / static_cast<double>(map.size());
  };
  const double fine = mean(flip_map(side, side, grey, checker)), coarse = mean(flip_map(side, side, grey, block));
  CHECK(coarse > 3.0 * fine);

  Pixels firefly = grey;
  firefly[32 * side + 32] = glm::vec3(1.0f);
  const std::vector<float> map = flip_map(side, side, grey, firefly);
  const auto brightest = std::max_element(map.begin(), map.end()) - map.begin();
  CHECK(brightest == 32 * side + 32);
  CHECK(map[0] < 1e-3f);  // the corner is farther away than any of the filters reach
}

TEST_CASE("FLIP gives the same bits on one thread and on two", "[compare]") {
  const Pixels a = random_pixels(100 * 70, 4), b = random_pixels(100 * 70, 5);
  std::vector<float> one, two;
  {
    const voxref::ThreadLimit limit(1);
    one = flip_map(100, 70, a, b);
  }
  {
    const voxref::ThreadLimit limit(2);
    two = flip_map(100, 70, a, b);
  }
  CHECK(one == two);
}

TEST_CASE("FLIP of a 512x512 picture is a matter of a second", "[compare]") {
  const Pixels a = random_pixels(512 * 512, 6), b = random_pixels(512 * 512, 7);
  const auto start = std::chrono::steady_clock::now();
  flip_map(512, 512, a, b);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  // 0.25 s on one core of the machine it was written on; ten times that means that separability was lost.
  INFO(seconds.count() << " s");
  CHECK(seconds.count() < 10.0);
}
