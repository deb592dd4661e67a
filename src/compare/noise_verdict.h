#pragma once
#include <cmath>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/statistics.h"
#include "image/image.h"

namespace voxref {

enum class Verdict : uint8_t { same, different, too_noisy };
std::string_view verdict_name(Verdict verdict);

/// How two images are judged of which at least one carries standard errors.
struct NoiseOptions {
  double significance = 0.01;  ///< probability that two renders of one truth are called different, all tests together
  double power = 0.9;          ///< with which the smallest detectable difference is found
  double margin = 0.01;        ///< of the image's mean, relative: a difference within it does not matter
  double tile_margin = 0.05;   ///< of a tile's mean, relative
  double dark = 0.1;           ///< share of the image's mean: what is darker is judged as if it were as bright as that
  int tile = 32;               ///< pixels a side
};

/// One quantity in one region of both images: means over its pixels.
struct RegionTest {
  int x = 0, y = 0, width = 0, height = 0;
  std::string channel;
  Estimate a, b;
  double margin = 0.0;      ///< absolute: the relative margin of the region's mean, see `dark`
  double confidence = 0.0;  ///< half the width of the interval around a - b that the equivalence test uses
  double detectable = 0.0;  ///< smallest difference that the corrected test would have found with the stated power
  double p = 1.0;           ///< of Welch's test, not corrected

  double difference() const { return a.mean - b.mean; }
  bool equivalent() const { return std::abs(difference()) + confidence <= margin; }
};

/// Two hypotheses are tested for every region: that the means agree (Welch's test, both variances; Bonferroni's
/// correction over all tests) and that they differ by more than the margin (two one-sided tests, Schuirmann 1987; all
/// regions must pass, which needs no correction). Half of the significance goes to the image and its tiles, half to
/// single pixels, which only the first test judges, and with an error that is at least their neighbourhood's.
///
/// `different`: some test found a difference that is not within its margin. Else `same`: the image and all tiles are
/// within theirs. Else `too_noisy`: more samples are needed, see `detectable`.
struct NoiseVerdict {
  Verdict verdict = Verdict::same;
  NoiseOptions options;
  std::vector<RegionTest> image;  ///< one per channel
  size_t image_open = 0;          ///< of these, neither different nor equivalent
  size_t tiles = 0;               ///< tests of tiles, over all channels
  size_t tiles_different = 0;     ///< over the margin, significantly
  size_t tiles_open = 0;          ///< neither different nor equivalent
  size_t pixels_different = 0;
  std::optional<RegionTest> worst_tile;     ///< largest |a - b| / standard error
  std::optional<RegionTest> noisiest_tile;  ///< largest detectable difference, relative to its margin
  std::optional<RegionTest> worst_pixel;    ///< of those that differ
};

/// Whether the image tells the noise of its R,G,B: by stderr.R,G,B or by stderr.Y.
bool has_noise(const Image& image);

/// @param a, b of equal size, finite (standard errors too), with R,G,B; tested in R,G,B, or in luminance where a side
/// has only stderr.Y; a
///        side without standard errors counts as exact
/// @throws Error when sizes differ or a channel is missing
NoiseVerdict judge_noise(const Image& a, const Image& b, const NoiseOptions& options);

nlohmann::json to_json(const NoiseVerdict& verdict);

}  // namespace voxref
