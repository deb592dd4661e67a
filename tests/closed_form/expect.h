#pragma once
#include <cmath>
#include <functional>

#include "catch.h"
#include "reference/small_scenes.h"

namespace voxref {

/// Checks the image against its known radiance, as the mean over the pixels of value / expected, in the green channel:
/// within four standard errors, themselves below 0.2 %. @param rounding relative error of float32 that may come on top
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
  const double deviation = ratio / count - 1.0, error = std::sqrt(variance) / count;
  CAPTURE(deviation, error, count);
  CHECK(error < 0.002);
  CHECK(std::abs(deviation) < 4.0 * error + rounding);
}

/// Where the ray of a pixel's centre meets the plane y = 0.
inline glm::dvec3 floor_point(const View& view, int x, int y) {
  const Ray ray = RayGenerator(view)({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
  return glm::dvec3(ray.origin) - glm::dvec3(ray.direction) * (static_cast<double>(ray.origin.y) / ray.direction.y);
}

}  // namespace voxref
