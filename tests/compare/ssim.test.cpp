#include "compare/ssim.h"

#include <cmath>
#include <random>
#include <vector>

#include "catch.h"

using voxref::ssim;

namespace {

std::vector<float> random_plane(size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::vector<float> plane(count);
  for (float& value : plane) value = uniform(generator);
  return plane;
}

/// The definition of Wang et al. 2004, window by window with two-dimensional weights and central moments.
double ssim_by_definition(int width, int height, const std::vector<float>& a, const std::vector<float>& b) {
  double total = 0.0;
  int windows = 0;
  for (int top = 0; top + 11 <= height; ++top)
    for (int left = 0; left + 11 <= width; ++left, ++windows) {
      double weights = 0.0, mean_a = 0.0, mean_b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
      const auto each = [&](auto&& use) {
        for (int y = 0; y < 11; ++y)
          for (int x = 0; x < 11; ++x) {
            const auto i = static_cast<size_t>((top + y) * width + left + x);
            use(std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / (2.0 * 1.5 * 1.5)), double{a[i]}, double{b[i]});
          }
      };
      each([&](double w, double u, double v) { weights += w, mean_a += w * u, mean_b += w * v; });
      mean_a /= weights, mean_b /= weights;
      each([&](double w, double u, double v) {
        aa += w / weights * (u - mean_a) * (u - mean_a);
        bb += w / weights * (v - mean_b) * (v - mean_b);
        ab += w / weights * (u - mean_a) * (v - mean_b);
      });
      total += (2 * mean_a * mean_b + 1e-4) * (2 * ab + 9e-4) /
               ((mean_a * mean_a + mean_b * mean_b + 1e-4) * (aa + bb + 9e-4));
    }
  return total / windows;
}

}  // namespace

TEST_CASE("SSIM of equal planes is one", "[compare]") {
  const std::vector<float> plane = random_plane(40 * 30, 1);
  CHECK(ssim(40, 30, plane, plane) == Approx(1.0).epsilon(1e-12));  // a few double roundings
}

TEST_CASE("SSIM of two constant planes is its luminance term", "[compare]") {
  const std::vector<float> a(20 * 20, 0.5f), b(20 * 20, 0.75f);
  // Without variance the contrast and structure term is C2 / C2. 1e-9: variances of rounding size against C2 = 9e-4.
  CHECK(ssim(20, 20, a, b) == Approx((2 * 0.5 * 0.75 + 1e-4) / (0.25 + 0.5625 + 1e-4)).epsilon(1e-9));
}

TEST_CASE("SSIM agrees with its definition computed window by window", "[compare]") {
  const std::vector<float> a = random_plane(24 * 17, 2), b = random_plane(24 * 17, 3);
  // 1e-9: the fast form takes variances as differences of sums in double.
  CHECK(ssim(24, 17, a, b) == Approx(ssim_by_definition(24, 17, a, b)).epsilon(1e-9));
  CHECK(ssim(24, 17, a, b) == ssim(24, 17, b, a));
}

TEST_CASE("SSIM of inverted structure is negative and small pictures have a value", "[compare]") {
  std::vector<float> a = random_plane(400, 4), b = a;
  for (float& value : b) value = 1.0f - value;
  CHECK(ssim(20, 20, a, b) < -0.8);
  CHECK(ssim(1, 1, std::vector<float>{0.2f}, std::vector<float>{0.2f}) == Approx(1.0));
  CHECK(ssim(3, 100, random_plane(300, 5), random_plane(300, 6)) < 0.9);
}
