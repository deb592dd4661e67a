#include "compare/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "catch.h"
#include "compare/flip_by_definition.h"
#include "parallel.h"

using voxref::flip_map;
using voxref::testing::FlipByDefinition;
using voxref::testing::Pixels;

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
      largest = std::max(
          largest, std::abs(FlipByDefinition{side, a, b}.at(x, y) - double{map[static_cast<size_t>(y * side + x)]}));
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
