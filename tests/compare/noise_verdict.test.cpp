// Verdicts under noise. What these tests cannot see: errors that are far from normal in every tile at once, as where
// all light comes by events that hardly a pixel has met.
#include "compare/noise_verdict.h"

#include <cmath>
#include <random>

#include "catch.h"
#include "compare/synthetic.h"
#include "make_scenes/builders.h"
#include "reference/path.h"
#include "scene/caster.h"

namespace voxref {

namespace {

/// wavy() with normal noise of a known size, its standard errors estimated from 16 values as the path tracer does.
Image noisy(int width, int height, double relative, unsigned seed, double factor = 1.0) {
  constexpr int randomizations = 16;
  Image image(width, height);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  testing::fill_layer(image, "", [&](int x, int y) { return float(factor) * testing::wavy(x, y); });
  image.add_layer("stderr");
  const auto values = image.layer(""), errors = image.layer("stderr");
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      double sum = 0.0, squares = 0.0;
      for (int k = 0; k < randomizations; ++k) {
        const double v = double{values[c][i]} * (1.0 + 4.0 * relative * normal(random));
        sum += v;
        squares += v * v;
      }
      const double mean = sum / randomizations;
      values[c][i] = float(mean);
      errors[c][i] = float(std::sqrt((squares / randomizations - mean * mean) / (randomizations - 1)));
    }
  return image;
}

}  // namespace

TEST_CASE("Independent renders are called different no more often than the significance says", "[noise_verdict]") {
  // 1,000 pairs of path-traced Cornell boxes, few samples: skewed errors, the hard case. At 5 % the count's expectation
  // is at most 50 with a deviation of 7; 75 is more than three of them above. Margins are made so small that no pair
  // passes for being equivalent.
  constexpr int pairs = 1000;
  const Scene scene = cornell_box(CornellLight::area);
  const Caster caster(scene);
  View view;
  view.camera = scene.cameras.front();
  view.width = view.height = 24;
  PathOptions path;
  path.spp = 32;
  const NoiseOptions options{.significance = 0.05, .margin = 1e-9, .tile_margin = 1e-9, .tile = 8};
  int different = 0;
  for (int pair = 0; pair < pairs; ++pair) {
    path.seed = uint64_t(2 * pair);
    const PathResult a = path_trace(scene, caster, view, path);
    path.seed = uint64_t(2 * pair + 1);
    const PathResult b = path_trace(scene, caster, view, path);
    different += judge_noise(a.image, b.image, options).verdict == Verdict::different;
  }
  INFO(different << " of " << pairs);
  CHECK(different <= 75);
}

TEST_CASE("A bias of the detectable size is found with the stated power", "[noise_verdict]") {
  // 64x64 pixels of 8 % noise: the image's mean is known to 0.13 %, and what is detectable is below 1 %. The trials'
  // share has a deviation of 3 % at 100 trials; the tiles' and pixels' tests only add to the power.
  constexpr int trials = 100;
  NoiseOptions options;
  options.margin = options.tile_margin = 1e-9;
  const NoiseVerdict clean = judge_noise(noisy(64, 64, 0.08, 1), noisy(64, 64, 0.08, 2), options);
  double detectable = 0.0;
  for (const RegionTest& image : clean.image) detectable = std::max(detectable, image.detectable / image.b.mean);
  CHECK(detectable < 0.01);
  int found = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto seed = unsigned(10 + 2 * trial);
    const Image a = noisy(64, 64, 0.08, seed, 1.0 + detectable), b = noisy(64, 64, 0.08, seed + 1);
    found += judge_noise(a, b, options).verdict == Verdict::different;
  }
  CHECK(found >= 81);  // 0.9 less three deviations
}

TEST_CASE("Little noise lets equal images pass, much of it says so, and a hot pixel is not hidden by it",
          "[noise_verdict]") {
  const NoiseOptions options;
  CHECK(judge_noise(noisy(64, 64, 0.02, 1), noisy(64, 64, 0.02, 2), options).verdict == Verdict::same);
  const NoiseVerdict rough = judge_noise(noisy(64, 64, 2.0, 1), noisy(64, 64, 2.0, 2), options);
  CHECK(rough.verdict == Verdict::too_noisy);
  REQUIRE(rough.noisiest_tile);
  CHECK(rough.noisiest_tile->detectable > rough.noisiest_tile->margin);

  Image hot = noisy(64, 64, 0.02, 3);
  hot.channel("G")[64 * 20 + 40] += 1.0f;
  const NoiseVerdict verdict = judge_noise(hot, noisy(64, 64, 0.02, 4), options);
  CHECK(verdict.verdict == Verdict::different);
  REQUIRE(verdict.worst_pixel);
  CHECK(verdict.worst_pixel->x == 40);
  CHECK(verdict.worst_pixel->y == 20);
  CHECK(verdict.worst_pixel->channel == "G");
}

TEST_CASE("A tile that differs is found and placed, though the image's mean hides it", "[noise_verdict]") {
  Image a = noisy(128, 128, 0.02, 5);
  for (const auto& plane : a.layer(""))
    for (int y = 64; y < 96; ++y)
      for (int x = 32; x < 64; ++x) plane[size_t(y) * 128 + size_t(x)] *= 1.08f;
  const NoiseVerdict verdict = judge_noise(a, noisy(128, 128, 0.02, 6), {});
  CHECK(verdict.verdict == Verdict::different);
  CHECK(verdict.tiles_different == 3);  // of one tile, in three channels
  REQUIRE(verdict.worst_tile);
  CHECK(verdict.worst_tile->x == 32);
  CHECK(verdict.worst_tile->y == 64);
}

TEST_CASE("A side that tells only the luminance's error is judged by luminance, one that tells none is exact",
          "[noise_verdict]") {
  Image a = noisy(64, 64, 0.02, 7), exact(64, 64);
  testing::fill_layer(exact, "", testing::wavy);
  CHECK(judge_noise(a, exact, {}).image.size() == 3);
  CHECK(judge_noise(a, exact, {}).verdict == Verdict::same);
  Image luminance_only(64, 64);
  testing::fill_layer(luminance_only, "", testing::wavy);
  std::ranges::fill(luminance_only.add("stderr.Y"), 1e-3f);
  const NoiseVerdict verdict = judge_noise(luminance_only, exact, {});
  REQUIRE(verdict.image.size() == 1);
  CHECK(verdict.image[0].channel == "Y");
}

}  // namespace voxref
