#include "diff_command.h"
#include "parse.h"

namespace voxref {

namespace {

void add_limits(CLI::App& command, DiffOptions& options) {
  const auto number = [&](const std::string& flag, const std::string& help, double low, double high, auto& field) {
    add_value_option(command, flag, "X", help, [&field, flag, low, high](const std::string& text) {
      field = parse_number(flag, text, low, high);
    });
  };
  constexpr double largest = 1e30;
  ImageLimits& limits = options.image.limits;
  number("--abs", "values may differ by X + REL |b| (default: 1e-5)", 0, largest, options.absolute);
  number("--rel", "see --abs (default: 1e-3)", 0, largest, options.relative);
  number("--fraction", "share of the values that may differ by more (default: 0)", 0, 1, options.fraction);
  number("--max-rmse", "images: the most that the RMSE may be", 0, largest, limits.rmse);
  number("--max-relmse", "the same of relMSE", 0, largest, limits.relmse);
  number("--max-flip", "the same of the mean FLIP", 0, 1, limits.flip);
  number("--max-hdr-flip", "the same of the mean HDR-FLIP", 0, 1, limits.hdr_flip);
  number("--min-psnr", "images: the least that the PSNR may be, dB", -largest, largest, limits.psnr);
  number("--min-ssim", "the same of SSIM", -1, 1, limits.ssim);
  number("--significance", "noisy images: chance that equal ones are called different (default: 0.01)", 1e-9, 0.5,
         limits.noise.significance);
  number("--margin", "noisy images: relative difference of the image's mean that does not matter (default: 0.01)", 1e-9,
         1, limits.noise.margin);
  number("--tile-margin", "the same of each tile's mean (default: 0.05)", 1e-9, 1, limits.noise.tile_margin);
  add_value_option(command, "--tile", "N", "side of the tiles, pixels (default: 32)",
                   [&](const std::string& text) { limits.noise.tile = int(parse_integer("--tile", text, 1, 65536)); });
  add_value_option(command, "--mip", "N", "only this level of detail of files that have several (default: all)",
                   [&](const std::string& text) { options.mip = int(parse_integer("--mip", text, 0, 31)); });
  command.add_flag("--volume", options.volume,
                   "a .npy of three sides is a volume, even where the last is short enough for an image's channels");
  command.add_flag("--strict", options.strict, "folders: a volume that only one side has is a difference");
}

void add_image_options(CLI::App& command, DiffOptions& options) {
  add_value_option(command, "--layer", "A[:B]",
                   "what is compared of A, and of B: a layer, a sum of layers, a channel (diffuse+specular:indirect); "
                   "default: R,G,B",
                   [&](const std::string& text) {
                     const size_t colon = text.find(':');
                     options.layer_a = text.substr(0, colon);
                     options.layer_b = colon == std::string::npos ? options.layer_a : text.substr(colon + 1);
                   });
  const auto transfer = [&](const std::string& flag, const std::string& side, std::optional<Transfer>& field) {
    add_value_option(command, flag, "linear|srgb|gamma22", "how " + side + " is encoded (default: as its file says)",
                     [&field, flag](const std::string& text) {
                       field = transfer_called(text);
                       if (!field) throw Error(flag, "'" + text + "' is not linear, srgb or gamma22");
                     });
  };
  transfer("--transfer-a", "A", options.transfer_a);
  transfer("--transfer-b", "B", options.transfer_b);
  add_value_option(command, "--exposure", "STOPS", "of the pictures (default: from B)", [&](const std::string& text) {
    options.image.exposure = float(parse_number("--exposure", text, -64, 64));
  });
  command.add_flag_callback(
      "--fast", [&] { options.image.perceptual = false; }, "images: no SSIM, FLIP and Yee");
}

}  // namespace

void add_diff_options(CLI::App& command, const std::shared_ptr<DiffOptions>& options) {
  command.add_option("A", options->a, "the one under test")->required()->type_name("");
  command.add_option("B", options->b, "the reference")->type_name("");
  add_value_option(command, "-o", "DIR", "writes difference pictures, result.json and report.html",
                   [options](const std::string& text) { options->output = text; });
  add_limits(command, *options);
  add_image_options(command, *options);
  add_value_option(command, "--recompute", "SCENE",
                   "folders: each stage of A also against what voxref computes on that stage's own input",
                   [options](const std::string& text) { options->scene.file = text; });
  add_settings_options(command, options->settings);
  add_value_option(command, "--background", "R,G,B", "constant radiance from outside, for --recompute",
                   [options](const std::string& text) {
                     constexpr float largest = 1e18f;
                     options->background = parse_vector("--background", text, 0.0f, largest);
                   });
  add_common_options(command, options->common);
}

}  // namespace voxref
