// How the error falls, and that the standard error tells it. The truths are closed forms, so that a bias cannot hide in
// the reference. What these cannot see: error bars that are wrong where samples are so rarely bright that all passes
// miss them alike (caustics, fireflies); no error bar made from the samples tells of those.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "catch.h"
#include "closed_form/expect.h"
#include "closed_form/polygon.h"
#include "compare/statistics.h"
#include "reference/small_scenes.h"

namespace voxref {

namespace {

/// A scene whose radiance is known at each pixel.
struct KnownImage {
  Scene scene;
  View view;
  std::vector<double> truth;  ///< green, one per pixel

  KnownImage(Scene known, const View& seen, const std::function<double(int x, int y)>& radiance)
      : scene(std::move(known)), view(seen) {
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) truth.push_back(radiance(x, y));
  }
};

/// Direct light of a tilted rectangle on a floor: sampled lights, weighed against the BSDF's rays.
KnownImage luminaire(int side) {
  Scene scene;
  add_floor(scene, 3.0f, add_material(scene, lambert(glm::vec3(0.6f))));
  add_quad(scene, {-0.7f, 0.9f, -0.4f}, {1.2f, 0.2f, 0.0f}, {0.0f, 0.0f, 0.8f},
           add_material(scene, lambert(glm::vec3(0.0f), glm::vec3(3.0f))));
  const View view = view_from({0.9f, 0.6f, 1.2f}, {0.0f, 0.0f, 0.3f}, side, side, 0.5f);
  const std::array<glm::dvec3, 4> corners = {
      glm::dvec3(-0.7, 0.9, -0.4), {0.5, 1.1, -0.4}, {0.5, 1.1, 0.4}, {-0.7, 0.9, 0.4}};
  return {std::move(scene), view, [&](int x, int y) {
            return 0.6 * 3.0 / std::numbers::pi * polygon_irradiance(corners, floor_point(view, x, y), {0.0, 1.0, 0.0});
          }};
}

/// Inside a closed furnace of emission 1 and albedo 0.8: all bounces, and roulette, which alone makes noise here.
KnownImage furnace(int side) {
  Scene scene;
  add_cube_interior(scene, add_material(scene, lambert(glm::vec3(0.8f), glm::vec3(1.0f))));
  return {std::move(scene), view_from({0.2f, 0.1f, 0.5f}, {0.0f, 0.0f, -1.0f}, side, side, 1.5f),
          [](int, int) { return 1.0 / (1.0 - static_cast<double>(0.8f)); }};
}

PathResult render(const KnownImage& image, const Caster& caster, const PathOptions& options) {
  return path_trace(image.scene, caster, image.view, options);
}

/// Root mean square of value / truth - 1 over the pixels.
double relative_error(const KnownImage& image, const PathResult& result) {
  double squares = 0.0;
  for (size_t i = 0; i < image.truth.size(); ++i)
    squares += std::pow(result.image.channel("G")[i] / image.truth[i] - 1.0, 2.0);
  return std::sqrt(squares / static_cast<double>(image.truth.size()));
}

/// Slope of log(error) over log(samples), least squares.
double slope(const std::vector<double>& samples, const std::vector<double>& errors) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    const double lx = std::log(samples[i]), ly = std::log(errors[i]);
    x += lx / n;
    y += ly / n;
    xx += lx * lx / n;
    xy += lx * ly / n;
  }
  return (xy - x * y) / (xx - x * x);
}

/// What many seeds say of the pixels' errors.
struct Seeds {
  std::vector<double> deviations;  ///< relative, mean over an image
  double mean_square = 0.0;        ///< of (value - truth) / standard error, over pixels and seeds
  double image_square = 0.0;       ///< the same of the images' means
  int least_spp = 1 << 30, most_spp = 0;

  Seeds(const KnownImage& image, PathOptions options, int count) {
    const Caster caster(image.scene);
    const auto pixels = static_cast<double>(image.truth.size());
    for (int seed = 0; seed < count; ++seed) {
      options.seed = 1000 + static_cast<uint64_t>(seed);
      const PathResult result = render(image, caster, options);
      deviations.push_back(0.0);
      double image_truth = 0.0;
      for (const double value : image.truth) image_truth += value / pixels;
      image_square += std::pow((result.mean.g - image_truth) / result.mean_stderr.g, 2.0) / count;
      for (size_t i = 0; i < image.truth.size(); ++i) {
        const double difference = result.image.channel("G")[i] - image.truth[i];
        const double z = difference / result.image.channel("stderr.G")[i];
        mean_square += z * z / (pixels * count);
        deviations.back() += difference / image.truth[i] / pixels;
      }
      least_spp = std::min(least_spp, result.spp);
      most_spp = std::max(most_spp, result.spp);
    }
  }
};

}  // namespace

TEST_CASE("The error falls as fast as theory says, down to a small one", "[convergence]") {
  // Theory: N^-1/2 for what independent choices decide, up to N^-3/4 for one stratified pair and a discontinuous
  // integrand, N^-3/2 for a smooth one (Owen 1997). An error over 256 pixels is known to 4 %, so five of them, a factor
  // of 4 apart, tell the slope to 0.01; four of those.
  const std::vector<double> samples = {16, 64, 256, 1024, 4096};
  struct Case {
    KnownImage image;
    double steepest, flattest, last;  // limits of the slope; of the last error
  };
  for (const Case& known : {Case{luminaire(16), -1.5, -0.6, 0.002}, Case{furnace(16), -0.75, -0.5, 0.01}}) {
    const Caster caster(known.image.scene);
    std::vector<double> errors;
    for (const double spp : samples) {
      PathOptions options;
      options.spp = static_cast<int>(spp);
      errors.push_back(relative_error(known.image, render(known.image, caster, options)));
    }
    const double measured = slope(samples, errors);
    CAPTURE(measured, errors.front(), errors.back());
    CHECK(measured < known.flattest + 0.04);
    CHECK(measured > known.steepest - 0.04);
    CHECK(errors.back() < known.last);
  }
}

TEST_CASE("Errors divided by their standard errors have the variance of Student's distribution", "[convergence]") {
  // Over 128 seeds and the pixels, against the truth. 256 samples are K = 16 passes, K - 1 degrees of freedom. The
  // limits are three standard errors of the mean square.
  PathOptions options;
  options.spp = 256;
  for (const KnownImage& image : {luminaire(4), furnace(4)}) {
    const Seeds seeds(image, options, 128);
    const SquareLimits limits(15.0, 128.0 * 16.0, 3.0);
    CAPTURE(seeds.mean_square, limits.expected, limits.margin);
    CHECK(limits.contain(seeds.mean_square));
    // The image's mean: pixels are independent, and so their degrees of freedom add up.
    const SquareLimits image_limits(15.0 * 16.0, 128.0, 3.0);
    CAPTURE(seeds.image_square, image_limits.expected, image_limits.margin);
    CHECK(image_limits.contain(seeds.image_square));
    const Welch test(estimate(seeds.deviations), {});
    CAPTURE(test.difference, test.error);
    CHECK(test.p() > 0.001);
  }
}

TEST_CASE("Stopping at a noise biases neither the image nor its standard errors", "[convergence]") {
  // The rule looks after each pass from the 16th on; the noises are chosen so that luck decides when it stops: after
  // some 20 passes of four samples, where it could bias most, and after some 30 and more of four and eight.
  struct Case {
    KnownImage image;
    double noise;
    int seeds;
    double most_square;
  };
  // Student's distribution has a mean square of 1.15 with the 16 passes at which the rule first looks, and 1.08
  // with 28. Roulette's samples are far from normal, and means of four still a little: 1.24 was measured there, error
  // bars that are 4 % too small.
  for (const Case& known : {Case{luminaire(8), 0.0285, 512, 1.2}, Case{furnace(8), 0.04, 512, 1.3},
                            Case{luminaire(8), 0.02, 128, 1.15}, Case{furnace(8), 0.03, 128, 1.15}}) {
    PathOptions options;
    options.spp = 0;
    options.noise = known.noise;
    const Seeds seeds(known.image, options, known.seeds);
    CAPTURE(known.noise, seeds.least_spp, seeds.most_spp);
    CHECK(seeds.least_spp >= 64);
    CHECK(seeds.least_spp < seeds.most_spp);
    const Welch test(estimate(seeds.deviations), {});
    const double found = test.detectable(0.001);
    CAPTURE(test.difference, test.error, found, seeds.mean_square);
    CHECK(test.p() > 0.001);
    CHECK(found < 0.003);
    CHECK(seeds.mean_square > 0.9);
    CHECK(seeds.mean_square < known.most_square);
  }
}

}  // namespace voxref
