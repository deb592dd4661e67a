#include "study/deviation.h"

#include <cmath>
#include <limits>
#include <random>

#include "catch.h"
#include "compare/metrics.h"
#include "compare/statistics.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "reference/path.h"
#include "study/study_scenes.h"
#include "study/truth.h"

using namespace voxref;

TEST_CASE("A deviation is rel_error of cli.md, and its error bar that of independent renderings", "[study]") {
  const StudyScene scene = cornell_point_scene();
  const Caster caster(scene.scene);
  const View view = sized(scene.view, 16);
  Settings settings;
  settings.grid.resolution = 20;
  settings.bounce.count = 1;
  const Image cone = cone_trace(scene.scene, caster, view, settings).image.image;
  std::vector<double> errors;
  double bar = 0.0;
  constexpr int seeds = 24;
  for (int seed = 0; seed < seeds; ++seed) {
    PathOptions options;
    options.spp = 16;
    options.seed = static_cast<uint64_t>(seed);
    const Image path = path_trace(scene.scene, caster, view, options).image;
    const Deviation d = deviation(measured_cone(cone, true), measured_path(path, true));
    const Metrics metrics = compare(cone, path, true, 0.0f);
    CHECK(d.rel_error() == Approx(metrics.rel_error).epsilon(1e-6));
    CHECK(d.bias + 1.0 == Approx(metrics.mean_ratio).epsilon(1e-6));
    errors.push_back(d.rel_error());
    bar += d.rel_error_stderr() / seeds;
  }
  // The scatter of 24 values is known to 15 %; the bar leaves out what moves the mean below the fraction.
  const double scatter = estimate(errors).error * std::sqrt(double(seeds));
  CHECK(bar / scatter == Approx(1.0).margin(0.5));
}

TEST_CASE("The error of a mean square is that of many draws, with more noise than signal too", "[study]") {
  constexpr size_t pixels = 400, draws = 2000;
  std::mt19937 random(1);
  for (const double noise : {0.2, 1.0, 3.0}) {
    std::vector<double> values, errors;
    for (size_t k = 0; k < draws; ++k) {
      std::vector<double> d(pixels);
      for (size_t i = 0; i < pixels; ++i) d[i] = std::normal_distribution<>(i % 2 ? 1.0 : -1.0, noise)(random);
      const MeanSquare found = mean_square(d, std::vector<double>(pixels, noise * noise));
      values.push_back(found.value);
      errors.push_back(found.error);
    }
    const Estimate value = estimate(values);
    CAPTURE(noise, value.mean, value.error);
    CHECK(std::abs(value.mean - 1.0) < 4.0 * value.error);  // true differences are 1 or -1
    // The scatter of 2000 draws is known to 1.6 %.
    CHECK(mean(errors) == Approx(value.error * std::sqrt(double(draws))).epsilon(0.06));
  }
}

TEST_CASE("The error of a mean square counts that few tries know its noise roughly", "[study]") {
  constexpr size_t pixels = 200, draws = 4000;
  std::mt19937 random(2);
  // Two tries are the fewest; 8 and 16 are the ladder's and the path tracer's. Without and with a true difference.
  for (const int tries : {2, 4, 8, 16})
    for (const double truth : {0.0, 0.5}) {
      std::vector<double> values;
      double squared_bar = 0.0;
      for (size_t k = 0; k < draws; ++k) {
        std::vector<double> d(pixels), v(pixels), of_pixel(static_cast<size_t>(tries));
        for (size_t i = 0; i < pixels; ++i) {
          for (double& value : of_pixel) value = std::normal_distribution<>(truth, std::sqrt(double(tries)))(random);
          const Estimate found = estimate(of_pixel);  // of variance 1
          d[i] = found.mean, v[i] = found.error * found.error;
        }
        const MeanSquare found = mean_square(d, v, tries - 1.0);
        values.push_back(found.value);
        squared_bar += found.error * found.error / draws;
      }
      const Estimate value = estimate(values);
      const double scatter = value.error * value.error * double(draws);
      CAPTURE(tries, truth, squared_bar, scatter);
      CHECK(std::abs(value.mean - truth * truth) < 4.0 * value.error);
      // The variance of 4000 draws is known to 2.2 %; taking the noise for known leaves out 6 / (tries - 1) of 2 or
      // more.
      CHECK(squared_bar > 0.91 * scatter);
      // Without a difference it cannot fall below the least that it can be, but above it: 5 to 13 % in the mean.
      CHECK(squared_bar < (truth == 0.0 ? 1.2 : 1.09) * scatter);
    }
}

TEST_CASE("A deviation that noise hides has an upper limit, and black against black none", "[study]") {
  // Noise of 1 in both pixels and a difference of 0.1: less than the noise, so that the error is clamped to 0.
  const Measured truth{{10.0, 10.0}, {1.0, 1.0}}, image{{10.1, 10.1}, {0.0, 0.0}};
  const Deviation hidden = deviation(image, truth);
  CHECK(hidden.rel_error() == 0.0);
  CHECK(hidden.square.value < 0.0);
  CHECK(hidden.square.root(3.0) > 0.0);
  const Measured black{{0.0, 0.0}, {0.0, 0.0}};
  CHECK(deviation(black, black).rel_error() == 0.0);
  CHECK(deviation(black, black).bias == 0.0);
  CHECK(std::isinf(deviation(image, black).rel_error()));
}

TEST_CASE("An image with a pixel that is not finite has no error, as in Metrics", "[study]") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const Measured truth{{10.0, 10.0}, {1.0, 1.0}}, exact{{10.0, 10.0}, {0.0, 0.0}};
  const auto none = [](const Deviation& d, size_t pixels) {
    CHECK(d.nonfinite == pixels);
    for (const double value : {d.bias, d.rel_error(), d.rel_error_stderr(), d.square.root(3.0), d.square.root(-3.0)})
      CHECK(std::isnan(value));
  };
  for (const double bad : {nan, infinity, -infinity})
    for (const Measured& held_against : {truth, exact}) {
      none(deviation({{10.0, bad}, {0.0, 0.0}}, held_against), 1);
      none(deviation({{bad, bad}, {0.0, 0.0}}, held_against), 2);
      none(deviation(held_against, {{10.0, bad}, {0.0, 0.0}}), 1);
      none(deviation(held_against, {{10.0, 10.0}, {bad, 0.0}}), 1);
    }
  CHECK(std::isnan(mean_square(std::vector{1.0, nan}, std::vector{0.5, 0.5}).root()));
  CHECK(deviation(exact, truth).nonfinite == 0);
}

TEST_CASE("What has no indirect light is compared as a whole", "[study]") {
  const StudyScene box = cornell_point_scene();
  const Scene plane = point_light_over_plane();
  PathOptions path;
  path.spp = 16;
  const auto traced = [&](const Scene& scene, const View& view) {
    return path_trace(scene, Caster(scene), view, path).image;
  };
  View view;
  view.camera = plane.cameras.at(0);
  const View small = sized(view, 8), of_box = sized(box.view, 8);
  CHECK(compares_indirect(plane, small));
  CHECK(!has_indirect_to_compare(plane, small, traced(plane, small)));
  CHECK(has_indirect_to_compare(box.scene, of_box, traced(box.scene, of_box)));
}
