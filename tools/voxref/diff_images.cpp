#include <fmt/format.h>

#include <array>

#include "compare/image_report.h"
#include "compare/select_layer.h"
#include "diff_command.h"
#include "image/linear_image.h"
#include "parallel.h"

namespace voxref {

namespace {

struct Side {
  const std::string &file, &layer;
  std::optional<Transfer> transfer;
};

Image read_side(const Side& side, int mip) {
  const auto needed = [&](std::string_view channel) { return layer_needs(side.layer, channel); };
  Image image = read_linear_image(side.file, side.transfer, needed, mip);
  // Without R,G,B the only channel is asked for, and only a look at all of them tells whether there is one.
  if (side.layer.empty() && !image.has_layer("")) image = read_linear_image(side.file, side.transfer, {}, mip);
  try {
    return select_layer(image, side.layer);
  } catch (const Error& error) {
    throw Error(side.file, error.what());
  }
}

/// A and B, read at the same time.
std::array<Image, 2> read_sides(const DiffOptions& options, const MipPair& mip) {
  const std::array<Side, 2> sides = {
      {{options.a, options.layer_a, options.transfer_a}, {options.b, options.layer_b, options.transfer_b}}};
  std::array<Image, 2> images;
  parallel_for(2, 1, [&](size_t i, size_t) { images[i] = read_side(sides[i], i == 0 ? mip.a : mip.b); });
  const Image &a = images[0], &b = images[1];
  if (a.width() != b.width() || a.height() != b.height())
    throw Error(options.a, "size",
                fmt::format("{}x{}, and {} has {}x{}", a.width(), a.height(), options.b, b.width(), b.height()));
  return images;
}

void say(Terminal& terminal, const ImageDiff& diff) {
  terminal.say(fmt::format("{:<9} {}", "verdict", verdict_name(diff.verdict)));
  for (const std::string& reason : diff.reasons) terminal.say(fmt::format("{:<9} {}", "because", reason));
  say_causes(terminal, diff.causes);
  const Difference& d = diff.all;
  terminal.say(fmt::format("{:<9} {} of {} values differ, max {:.4g}, mean {:+.4g}, RMSE {:.4g}, relMSE {:.4g}",
                           "values", d.differing, d.values, d.max_abs, d.mean_signed(), d.rmse(), d.relmse()));
  if (const auto& eye = diff.perceptual)
    terminal.say(
        fmt::format("{:<9} PSNR {:.2f} dB, SSIM {:.4f}, FLIP {:.4f}, HDR-FLIP {:.4f} ({} exposures, {:+.2f} to "
                    "{:+.2f} stops), Yee {} pixels",
                    "pictures", diff.psnr, eye->displayed.ssim, eye->displayed.flip, eye->hdr_flip,
                    eye->exposures.count, eye->exposures.start, eye->exposures.stop, eye->yee_pixels));
  if (diff.same_seed)
    terminal.warn("voxref: warning: both images were rendered with one seed: their errors are not independent");
}

/// One level of detail, as it was compared.
struct Level {
  int mip = 0;
  std::array<Image, 2> images;
  ImageDiff diff;
};

nlohmann::json summary(const Level& level) {
  const Difference& all = level.diff.all;
  return {{"mip", level.mip},
          {"verdict", verdict_name(level.diff.verdict)},
          {"max_abs", all.max_abs},
          {"rmse", all.rmse()},
          {"differing", {{"count", all.differing}, {"fraction", all.fraction()}}}};
}

}  // namespace

int diff_images_of(const DiffOptions& options, Terminal& terminal) {
  ImageDiffOptions image = options.image;
  if (options.absolute || options.relative) image.limits.tolerance = options.tolerance();
  image.limits.fraction = options.fraction;
  // Of several levels the first that is not the same is told in full, else the largest.
  std::optional<Level> told;
  nlohmann::json mips = nlohmann::json::array();
  const std::vector<MipPair> pairs = mip_pairs(options);
  for (const MipPair& pair : pairs) {
    Level level{pair.a, read_sides(options, pair), {}};
    level.diff = diff_images(level.images[0], level.images[1], image, terminal.progress());
    if (pairs.size() > 1) terminal.say(fmt::format("mip {:<5} {}", level.mip, verdict_name(level.diff.verdict)));
    mips.push_back(summary(level));
    if (!told || (told->diff.verdict == Verdict::same && level.diff.verdict != Verdict::same)) told = std::move(level);
  }
  const ImageDiff& diff = told->diff;
  say(terminal, diff);
  nlohmann::json result = to_json(diff);
  if (pairs.size() > 1) result.update({{"mip", told->mip}, {"mips", std::move(mips)}});
  if (!options.output.empty())
    write_image_report(options.output, {told->images[0], told->images[1], diff, result, diff_origin(options)});
  return finish_diff(terminal, options, result, diff.verdict);
}

}  // namespace voxref
