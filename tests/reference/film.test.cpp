#include "reference/film.h"

#include <cmath>
#include <random>
#include <vector>

#include "catch.h"

namespace voxref {

namespace {

/// A pass whose mean is `value` in all channels, direct light.
PixelBatch batch(double value) {
  PixelBatch batch;
  batch.layers.direct = glm::vec3(static_cast<float>(value));
  return batch;
}

double stderr_of(const Film& film) { return film.image().channel("stderr.G")[0]; }

}  // namespace

TEST_CASE("With equal passes the standard error is the textbook's", "[film]") {
  const std::vector<double> means = {1.0, 2.5, 0.5, 4.0, 2.0};
  Film film(1, 1);
  double sum = 0.0;
  for (const double mean : means) {
    film.add(std::vector{batch(mean)}, 8);
    sum += mean / static_cast<double>(means.size());
  }
  double scatter = 0.0;
  for (const double mean : means) scatter += (mean - sum) * (mean - sum);
  CHECK(film.samples() == 40);
  CHECK(film.image().channel("G")[0] == Approx(sum));
  CHECK(stderr_of(film) == Approx(std::sqrt(scatter / (5.0 * 4.0))).epsilon(1e-6));
  CHECK(film.noise() == Approx(std::sqrt(scatter / (5.0 * 4.0)) / sum).epsilon(1e-6));
}

TEST_CASE("With unequal passes the squared standard error is right in the mean", "[film]") {
  // Passes of 16 x 1 and 8 x 4 samples, the long ones better than independent samples would be: variance 1 and 1/8. The
  // mean then has variance (16 x 1 + 8 x 16 / 8) / 48^2. The estimator's bias is a few per cent at so few passes.
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double squares = 0.0, truth = (16.0 + 8.0 * 16.0 / 8.0) / (48.0 * 48.0);
  constexpr int repetitions = 4000;
  for (int i = 0; i < repetitions; ++i) {
    Film film(1, 1);
    for (int pass = 0; pass < 16; ++pass) film.add(std::vector{batch(5.0 + normal(random))}, 1);
    for (int pass = 0; pass < 8; ++pass) film.add(std::vector{batch(5.0 + normal(random) / std::sqrt(8.0))}, 4);
    const double error = stderr_of(film);
    squares += error * error / repetitions;
  }
  // The mean of 4000 estimates of about 20 degrees of freedom is known to 0.5 %.
  CHECK(squares == Approx(truth).epsilon(0.05));
}

TEST_CASE("A million passes of a tiny spread keep their standard error", "[film]") {
  // 1 +- 1e-3 by turns: float32 sums would stand still at 2^24. Exactly 1e-3 / sqrt(passes - 1), to the float32 of a
  // value.
  Film film(1, 1);
  constexpr int passes = 1 << 20;
  for (int pass = 0; pass < passes; ++pass) film.add(std::vector{batch(pass % 2 ? 1.001 : 0.999)}, 64);
  CHECK(film.image().channel("G")[0] == Approx(1.0).epsilon(1e-6));
  CHECK(stderr_of(film) == Approx(1e-3 / std::sqrt(passes - 1.0)).epsilon(1e-3));
}

TEST_CASE("The image's error is that of independent pixels", "[film]") {
  Film film(2, 1);
  film.add(std::vector{batch(1.0), batch(4.0)}, 1);
  film.add(std::vector{batch(3.0), batch(4.0)}, 1);
  CHECK(film.mean().g == Approx(3.0f));
  CHECK(film.mean_stderr().g == Approx(0.5f));  // pixels: 1 and 0
}

}  // namespace voxref
