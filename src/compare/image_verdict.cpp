#include "compare/image_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxref {

namespace {

/// Adds a reason for every metric that is over its limit. NaN is over every limit.
void hold_against_limits(ImageDiff& diff, const ImageLimits& limits) {
  constexpr double absent = std::numeric_limits<double>::quiet_NaN();
  const auto over = [&](const char* name, double value, const std::optional<double>& limit, bool at_least) {
    if (!limit || (at_least ? value >= *limit : value <= *limit)) return;
    diff.reasons.push_back(fmt::format("{} is {:.6g}, {} {:g}", name, value, at_least ? "below" : "above", *limit));
  };
  const auto& eye = diff.perceptual;
  over("RMSE", diff.all.rmse(), limits.rmse, false);
  over("relMSE", diff.all.relmse(), limits.relmse, false);
  over("PSNR", diff.psnr, limits.psnr, true);
  over("SSIM", eye ? eye->displayed.ssim : absent, limits.ssim, true);
  over("FLIP", eye ? eye->displayed.flip : absent, limits.flip, false);
  over("HDR-FLIP", eye ? eye->hdr_flip : absent, limits.hdr_flip, false);
}

/// Quotes the image's mean where that is open, for then no tile need be; else the noisiest tile.
std::string too_noisy_reason(const NoiseVerdict& noise) {
  const auto relative = [](const RegionTest& region) { return region.detectable / region.margin; };
  const auto in_words = [](const RegionTest& region) {
    return fmt::format("a difference of {:.3g} ({}) would have been found, {:.3g} matters", region.detectable,
                       region.channel, region.margin);
  };
  if (noise.image_open == 0)
    return fmt::format("{} of {} tiles are too noisy to say: in the noisiest, at ({}, {}), {}", noise.tiles_open,
                       noise.tiles, noise.noisiest_tile->x, noise.noisiest_tile->y, in_words(*noise.noisiest_tile));
  return fmt::format("{} of {} image means and {} of {} tiles are too noisy to say: of the image's mean {}",
                     noise.image_open, noise.image.size(), noise.tiles_open, noise.tiles,
                     in_words(*std::ranges::max_element(noise.image, {}, relative)));
}

std::string noise_reason(const NoiseVerdict& noise) {
  if (noise.verdict == Verdict::too_noisy) return too_noisy_reason(noise);
  for (const RegionTest& image : noise.image)
    if (!image.equivalent() && std::abs(image.difference()) > image.detectable)
      return fmt::format("the image's mean {} is {:.6g} instead of {:.6g}, {:.1f} standard errors off", image.channel,
                         image.a.mean, image.b.mean,
                         std::abs(image.difference()) / std::hypot(image.a.error, image.b.error));
  if (noise.tiles_different > 0) {
    const RegionTest& tile = *noise.worst_tile;
    return fmt::format("{} of {} tiles differ; the tile at ({}, {}) has {} {:.6g} instead of {:.6g}",
                       noise.tiles_different, noise.tiles, tile.x, tile.y, tile.channel, tile.a.mean, tile.b.mean);
  }
  if (noise.pixels_different > 0) {
    const RegionTest& pixel = *noise.worst_pixel;
    return fmt::format("{} single values differ; pixel ({}, {}) has {} {:.6g} instead of {:.6g}",
                       noise.pixels_different, pixel.x, pixel.y, pixel.channel, pixel.a.mean, pixel.b.mean);
  }
  return "the image's mean differs";
}

}  // namespace

void judge_images(ImageDiff& diff, const Image& a, const Image& b, const ImageLimits& limits) {
  const Difference& all = diff.all;
  if (!diff.all_finite()) {
    if (const auto& first = all.first_nonfinite)
      diff.reasons.push_back(
          fmt::format("{} values are NaN or infinite, the first at pixel ({}, {}) {}: {} instead of {}", all.nonfinite,
                      first->at.x, first->at.y, "RGB"[first->channel], first -> a, first -> b));
    if (diff.errors.a + diff.errors.b > 0)
      diff.reasons.push_back(fmt::format("{} standard errors are NaN or infinite, the first at {}",
                                         diff.errors.a + diff.errors.b, diff.errors.first));
    diff.verdict = Verdict::different;
    return;
  }
  hold_against_limits(diff, limits);
  const bool by_values = !limits.by_metrics() || limits.tolerance;
  if (by_values && all.fraction() > limits.fraction) {
    const bool noisy = has_noise(a) || has_noise(b);
    if (noisy && !limits.tolerance) {
      diff.noise = judge_noise(a, b, limits.noise);
      diff.verdict = diff.noise->verdict;
      if (diff.verdict != Verdict::same) diff.reasons.push_back(noise_reason(*diff.noise));
    } else {
      diff.reasons.push_back(fmt::format("{} of {} values differ by more than {:g} + {:g} |b|", all.differing,
                                         all.values, diff.tolerance.absolute, diff.tolerance.relative));
    }
  }
  if (!diff.reasons.empty() && diff.verdict != Verdict::too_noisy) diff.verdict = Verdict::different;
}

}  // namespace voxref
