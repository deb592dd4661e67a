#pragma once
#include <cmath>
#include <functional>

#include "catch.h"
#include "reference/small_scenes.h"

namespace voxref {

// What agreement with a closed form means: within three standard errors, themselves at most 0.05 % of the value. An
// unbiased estimate is outside with 0.27 %, so one of the some 30 checks that use these limits would be with 8 %; seeds
// are fixed, so that what passed once passes always. A bias of 0.05 % x (3 + 1.28) = 0.22 % is found with 90 %.
constexpr double most_errors = 3.0, largest_error = 0.0005;

/// Checks that `deviation`, relative, is noise. @param rounding relative error of float32 that may come on top
inline void expect_agreement(double deviation, double error, double rounding = 1e-5) {
  CAPTURE(deviation, error);
  CHECK(error <= largest_error);
  CHECK(std::abs(deviation) < most_errors * error + rounding);
}

/// Checks the image against its known radiance, as the mean over the pixels of value / expected, in the green channel.
/// @param expected radiance at a pixel, or 0 where the pixel is to be left out
inline void expect_radiance(const PathResult& result, const std::function<double(int x, int y)>& expected,
                            double rounding = 1e-5) {
  CHECK(result.nonfinite == 0);
  double ratio = 0.0, variance = 0.0;
  int count = 0;
  for (int y = 0; y < result.image.height(); ++y)
    for (int x = 0; x < result.image.width(); ++x) {
      const double truth = expected(x, y);
      if (truth == 0.0) continue;
      const auto pixel = static_cast<size_t>(y * result.image.width() + x);
      ratio += result.image.channel("G")[pixel] / truth;
      const double error = result.image.channel("stderr.G")[pixel] / truth;
      variance += error * error;
      ++count;
    }
  REQUIRE(count > 0);
  expect_agreement(ratio / count - 1.0, std::sqrt(variance) / count, rounding);
}

/// Checks the image's mean against its known value, in the green channel.
inline void expect_mean(const PathResult& result, double expected, double rounding = 1e-5) {
  CHECK(result.nonfinite == 0);
  expect_agreement(result.mean.g / expected - 1.0, result.mean_stderr.g / expected, rounding);
}

/// Where the ray of a pixel's centre meets the plane y = 0.
inline glm::dvec3 floor_point(const View& view, int x, int y) {
  const Ray ray = RayGenerator(view)({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
  return glm::dvec3(ray.origin) - glm::dvec3(ray.direction) * (static_cast<double>(ray.origin.y) / ray.direction.y);
}

}  // namespace voxref
