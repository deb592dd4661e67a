#include "compare/metrics.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "compare/synthetic.h"
#include "error.h"
#include "parallel.h"

using voxref::compare;
using voxref::Image;
using voxref::Metrics;
using voxref::testing::add_noise;
using voxref::testing::cone_image;
using voxref::testing::fill_layer;
using voxref::testing::path_image;
using voxref::testing::wavy;

namespace {
constexpr int width = 160, height = 120;
constexpr auto flat = [](float value) { return [value](int, int) { return glm::vec3(value); }; };
constexpr auto scaled = [](float factor) { return [factor](int x, int y) { return factor * wavy(x, y); }; };
}  // namespace

TEST_CASE("Metrics of equal images say so", "[compare]") {
  const Metrics metrics = compare(cone_image(width, height, wavy), path_image(width, height, wavy), false, 0.0f);
  CHECK(metrics.mean_ratio == 1.0);
  CHECK(metrics.rel_error == 0.0);
  CHECK(std::isnan(metrics.noise_share));  // no share of nothing
  CHECK(metrics.rmse == 0.0);
  CHECK(metrics.relmse == 0.0);
  CHECK(metrics.psnr == std::numeric_limits<double>::infinity());
  CHECK(metrics.ssim == Approx(1.0).epsilon(1e-12));
  CHECK(metrics.flip == 0.0);
  CHECK(voxref::to_json(metrics)["psnr"].is_null());
  CHECK(voxref::to_json(metrics)["noise_share"].is_null());
}

TEST_CASE("Metrics of a constant image against a scaled one are their closed forms", "[compare]") {
  const Metrics metrics =
      compare(cone_image(width, height, flat(0.5f)), path_image(width, height, flat(0.4f)), false, 0.0f);
  // 1e-6: the pixels are floats.
  CHECK(metrics.mean_ratio == Approx(1.25).epsilon(1e-6));
  CHECK(metrics.rel_error == Approx(0.25).epsilon(1e-6));
  CHECK(metrics.noise_share == 0.0);
  CHECK(metrics.rmse == Approx(0.1).epsilon(1e-6));
  CHECK(metrics.relmse == Approx(0.01 / (0.16 + 0.01)).epsilon(1e-6));
  const auto encoded = [](double v) { return 1.055 * std::pow(v, 1 / 2.4) - 0.055; };
  CHECK(metrics.psnr == Approx(-20.0 * std::log10(encoded(0.5) - encoded(0.4))).epsilon(1e-5));
}

TEST_CASE("Swapping the two images inverts the mean ratio", "[compare]") {
  const Metrics ahead = compare(cone_image(width, height, scaled(1.1f)), path_image(width, height, wavy), false, 0.0f);
  const Metrics back = compare(cone_image(width, height, wavy), path_image(width, height, scaled(1.1f)), false, 0.0f);
  CHECK(ahead.mean_ratio == Approx(1.1).epsilon(1e-6));
  CHECK(back.mean_ratio == Approx(1.0 / 1.1).epsilon(1e-6));
  CHECK(ahead.flip == Approx(back.flip).epsilon(1e-12));
  CHECK(ahead.ssim == Approx(back.ssim).epsilon(1e-12));
}

TEST_CASE("Noise of known size is taken out of the error and leaves the planted bias", "[compare]") {
  const Image cone = cone_image(width, height, flat(0.5f));
  Image path = path_image(width, height, flat(0.4f), 0.1f);
  add_noise(path, "", 0.1f, 7);
  const Metrics metrics = compare(cone, path, false, 0.0f);
  // With bias b = noise s = 0.1 the variance of d^2 is 2 s^4 + 4 s^2 b^2; over 19200 pixels mean(d^2) strays by 1.8e-4,
  // so b^2 = 0.01 by 1.8 %, rel_error by half of that, noise_share of 0.5 by 0.9 %: four standard deviations.
  CHECK(metrics.rel_error == Approx(0.25).epsilon(0.036));
  CHECK(metrics.noise_share == Approx(0.5).epsilon(0.036));
  CHECK(metrics.mean_ratio == Approx(1.25).epsilon(0.0073));  // 4 x 0.1 / sqrt(19200) / 0.4

  for (float& value : path.channel("stderr.Y")) value = 0.0f;
  CHECK(compare(cone, path, false, 0.0f).rel_error > 0.34);  // sqrt(2) times as much when the noise is not known
}

TEST_CASE("An image that is right but for noise has no error left and a noise share of one", "[compare]") {
  Image path = path_image(width, height, wavy, 0.05f);
  add_noise(path, "", 0.05f, 8);
  const Metrics metrics = compare(cone_image(width, height, wavy), path, false, 0.0f);
  CHECK(metrics.noise_share == Approx(1.0).epsilon(4.0 * std::sqrt(2.0 / (width * height))));
  // mean(d^2) - mean(s^2) strays from 0 by s^2 sqrt(2/n) = 2.6e-5: its root at four deviations, over the mean of 0.33.
  CHECK(metrics.rel_error < std::sqrt(4.0 * 2.6e-5) / 0.33);
}

TEST_CASE("With punctual lights alone the indirect light is compared", "[compare]") {
  Image cone = cone_image(width, height, flat(0.8f)), path = path_image(width, height, flat(0.8f), 0.5f);
  fill_layer(cone, "diffuse", flat(0.3f));
  fill_layer(cone, "specular", flat(0.15f));
  for (float& value : path.channel("stderr.indirect.Y")) value = 0.03f;  // path indirect: 0.4
  const Metrics metrics = compare(cone, path, true, 0.0f);
  CHECK(metrics.indirect_only);
  CHECK(metrics.mean_ratio == Approx(0.45 / 0.4).epsilon(1e-6));
  CHECK(metrics.rel_error == Approx(std::sqrt(0.05 * 0.05 - 0.03 * 0.03) / 0.4).epsilon(1e-5));
  CHECK(metrics.noise_share == Approx(0.36).epsilon(1e-5));
  CHECK(metrics.rmse == 0.0);  // of R,G,B all the same
  CHECK(voxref::to_json(metrics)["of"] == "indirect");
  CHECK(voxref::to_json(compare(cone, path, false, 0.0f))["of"] == "rgb");
}

TEST_CASE("A pixel that is not finite leaves no metric standing and is located", "[compare]") {
  const float not_a_number = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const Image cone = cone_image(width, height, wavy), path = path_image(width, height, wavy);
  const auto check = [&](const Image& a, const Image& b, bool indirect, size_t in_cone, size_t in_path,
                         const char* first) {
    const Metrics metrics = compare(a, b, indirect, 0.0f);
    CHECK(metrics.nonfinite_cone == in_cone);
    CHECK(metrics.nonfinite_path == in_path);
    CHECK(metrics.first_nonfinite == first);
    const nlohmann::json json = voxref::to_json(metrics);
    for (const char* key : {"mean_ratio", "rel_error", "noise_share", "rmse", "relmse", "psnr", "ssim", "flip"})
      CHECK(json[key].is_null());
  };
  Image bad = cone;
  bad.channel("G")[width * 3 + 5] = not_a_number;
  check(bad, path, false, 1, 0, "cone pixel (5, 3)");
  bad = path;
  bad.channel("B")[2] = infinity;
  bad.channel("R")[width] = -infinity;
  check(cone, bad, false, 0, 2, "path pixel (2, 0)");
  bad = path;
  bad.channel("stderr.Y")[7] = not_a_number;
  check(cone, bad, false, 0, 1, "path pixel (7, 0)");
  bad = cone;
  bad.channel("specular.R")[0] = not_a_number;
  check(bad, path, true, 1, 0, "cone pixel (0, 0)");
  bad = cone;
  bad.channel("R")[4] = not_a_number;  // rmse and the pictures are of R,G,B even then
  check(bad, path, true, 1, 0, "cone pixel (4, 0)");
  check(cone_image(width, height, flat(not_a_number)), path_image(width, height, flat(not_a_number)), false,
        width * height, width * height, "cone pixel (0, 0)");
}

TEST_CASE("Over a black reference an error is undefined, and none where both are black", "[compare]") {
  const Image black = path_image(width, height, flat(0.0f));
  const Metrics both = compare(cone_image(width, height, flat(0.0f)), black, false, 0.0f);
  CHECK(both.rel_error == 0.0);
  CHECK(voxref::to_json(both)["mean_ratio"].is_null());
  CHECK(voxref::to_json(compare(cone_image(width, height, flat(0.1f)), black, false, 0.0f))["rel_error"].is_null());
}

TEST_CASE("Images that do not fit together are refused", "[compare]") {
  const Image cone = cone_image(width, height, wavy);
  CHECK_THROWS_AS(compare(cone, path_image(height, width, wavy), false, 0.0f), voxref::Error);
  CHECK_THROWS_AS(compare(cone, Image(width, height), false, 0.0f), voxref::Error);
}

TEST_CASE("Metrics are the same bits on one thread and on two", "[compare]") {
  Image path = path_image(width, height, wavy, 0.05f);
  add_noise(path, "", 0.05f, 9);
  const Image cone = cone_image(width, height, scaled(1.1f));
  const auto on = [&](int threads) {
    const voxref::ThreadLimit limit(threads);
    return voxref::to_json(compare(cone, path, false, 0.0f));
  };
  CHECK(on(1) == on(2));
}

TEST_CASE("The automatic exposure brings the 99th percentile to 0.9", "[compare]") {
  Image image = path_image(100, 100, flat(0.225f));
  CHECK(voxref::auto_exposure(image) == Approx(2.0).epsilon(1e-5));
  for (size_t i = 0; i < 50; ++i) image.channel("G")[i] = 1e6f;  // half a percent of lamp
  image.channel("R")[60] = std::numeric_limits<float>::quiet_NaN();
  CHECK(voxref::auto_exposure(image) == Approx(2.0).epsilon(1e-5));
  CHECK(voxref::auto_exposure(path_image(4, 4, flat(0.0f))) == 0.0f);
  CHECK(voxref::auto_exposure(path_image(4, 4, flat(1e-44f))) == 64.0f);
}
