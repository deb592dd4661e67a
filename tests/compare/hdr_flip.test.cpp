// HDR-FLIP against its definition, worked out apart from the code: exposures by bisection on the tone curve as
// Narkowicz prints it, and the largest LDR-FLIP over them pixel by pixel. Published values exist only for pictures,
// which do not belong here.
#include "compare/hdr_flip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "catch.h"
#include "compare/flip_by_definition.h"

namespace voxref {

namespace {

using testing::Pixels;

/// Narkowicz's curve, of 0.6 x as he has it in his text, not clipped.
double aces(double radiance) {
  const double x = 0.6 * radiance;
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

/// The radiance that the curve takes to 0.85; it rises everywhere.
double nearly_white() {
  double low = 0.0, high = 100.0;
  for (int i = 0; i < 100; ++i) (aces(0.5 * (low + high)) < 0.85 ? low : high) = 0.5 * (low + high);
  return high;
}

Pixels shown(const Pixels& pixels, double stops) {
  Pixels result = pixels;
  for (glm::vec3& color : result)
    for (int c = 0; c < 3; ++c)
      color[c] = float(std::min(1.0, aces(std::exp2(stops) * std::max(0.0, double{color[c]}))));
  return result;
}

}  // namespace

TEST_CASE("HDR-FLIP's exposures take the brightest and the median luminance to nearly white", "[compare]") {
  // 4 and 64 times a grey; of 9 pixels the median is the fifth, of an even number the upper of the middle two.
  Pixels pixels(9, glm::vec3(0.25f));
  for (size_t i = 4; i < 8; ++i) pixels[i] = glm::vec3(1.0f);
  pixels[8] = glm::vec3(16.0f);
  const FlipExposures exposures = flip_exposures(pixels);
  CHECK(exposures.start == Approx(std::log2(nearly_white() / 16.0)).epsilon(1e-5));  // floats
  CHECK(exposures.stop == Approx(std::log2(nearly_white())).epsilon(1e-5));
  CHECK(exposures.count == 4);
  const FlipExposures grey = flip_exposures(Pixels(16, glm::vec3(0.5f)));
  CHECK(grey.start == grey.stop);
  CHECK(grey.count == 2);
  const FlipExposures black = flip_exposures(Pixels(16, glm::vec3(0.0f)));
  CHECK(std::isfinite(black.start));
  CHECK(std::isfinite(black.stop));
}

TEST_CASE("HDR-FLIP is the largest LDR-FLIP over its exposures, pixel by pixel", "[compare]") {
  const int side = 20;
  std::mt19937 random(21);
  std::uniform_real_distribution<float> stops(-6.0f, 6.0f), hue(0.3f, 1.0f), other(0.5f, 2.0f);
  Pixels reference(side * side), test;
  for (size_t i = 0; i < reference.size(); ++i) {
    // Blocks of four pixels, twelve stops apart, so that different exposures see different ones.
    const size_t first = i / side / 4 * 4 * side + i % side / 4 * 4;
    reference[i] =
        first == i ? std::exp2(stops(random)) * glm::vec3(hue(random), hue(random), hue(random)) : reference[first];
  }
  test = reference;
  for (size_t i = 0; i < test.size(); ++i)
    if (i % 3 == 0) test[i] *= other(random);
  const FlipExposures exposures{-5.0f, 4.0f, 4};
  const std::vector<float> map = hdr_flip_map(side, side, reference, test, exposures);
  std::vector<double> expected(map.size(), 0.0);
  for (const double stop : {-5.0, -2.0, 1.0, 4.0}) {
    const Pixels a = shown(reference, stop), b = shown(test, stop);
    const testing::FlipByDefinition flip{side, a, b};
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        double& largest = expected[size_t(y * side + x)];
        largest = std::max(largest, flip.at(x, y));
      }
  }
  double worst = 0.0, mean = 0.0;
  for (size_t i = 0; i < map.size(); ++i) {
    worst = std::max(worst, std::abs(expected[i] - double{map[i]}));
    mean += expected[i] / double(map.size());
  }
  CHECK(mean > 0.05);
  CHECK(worst < 1e-3);  // of LDR-FLIP's own test 5e-4, and twice that for the tone curve in floats
}

TEST_CASE("HDR-FLIP sees a light beyond the squares that a float can hold", "[compare]") {
  const Pixels dark(81, glm::vec3(0.1f));
  Pixels lit = dark;
  lit[40] = glm::vec3(1e30f);
  const std::vector<float> map = hdr_flip_map(9, 9, dark, lit, flip_exposures(dark));
  CHECK(map[40] > 0.05f);  // one white pixel between grey ones
  CHECK(std::ranges::all_of(map, [](float v) { return std::isfinite(v); }));
  Pixels white = dark;
  white[40] = glm::vec3(1e6f);  // as white as can be shown: no brighter light looks brighter
  CHECK(hdr_flip_map(9, 9, dark, white, flip_exposures(dark)) == map);
}

}  // namespace voxref
