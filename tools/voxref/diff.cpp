#include <fmt/format.h>

#include "commands.h"
#include "compare/diff_report.h"
#include "compare/select_layer.h"
#include "compare/volume_causes.h"
#include "file.h"
#include "image/linear_image.h"
#include "inputs.h"
#include "outputs.h"
#include "parallel.h"
#include "parse.h"
#include "provenance.h"
#include "recompute.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

struct Options {
  CommonOptions common;
  std::string a, b, output;
  std::string layer_a, layer_b;
  std::optional<Transfer> transfer_a, transfer_b;
  std::optional<double> absolute, relative;
  double fraction = 0.0;
  ImageDiffOptions image;
  bool strict = false;
  SceneOptions scene;
  SettingsOptions settings;
  glm::vec3 background{0.0f};

  Tolerance tolerance() const {
    const Tolerance usual;
    return {absolute.value_or(usual.absolute), relative.value_or(usual.relative)};
  }
  VolumeLimits volume_limits() const { return {tolerance(), fraction, strict}; }
};

/// What was compared, for reports.
nlohmann::json origin(const Options& options) {
  nlohmann::json provenance = program_provenance();
  provenance["a"] = options.a;
  provenance["b"] = options.b;
  return provenance;
}

void say_causes(Terminal& terminal, const std::vector<Cause>& causes) {
  for (const Cause& cause : causes) terminal.say(fmt::format("{:<9} {}", "cause", cause.mistake));
}

void say_difference(Terminal& terminal, const Difference& d) {
  terminal.say(fmt::format("{:<9} {} of {} values differ, max {:.4g}, mean {:+.4g}, RMSE {:.4g}, relMSE {:.4g}",
                           "values", d.differing, d.values, d.max_abs, d.mean_signed(), d.rmse(), d.relmse()));
}

int finish(Terminal& terminal, const Options& options, const nlohmann::json& result, Verdict verdict) {
  if (!options.output.empty()) terminal.say("report    " + (fs::path(options.output) / "report.html").string());
  terminal.result(result);
  return verdict == Verdict::same ? exit_done : exit_outside_limits;
}

// ------------------------------------------------------------------------------------------------------------ images

Image read_side(const std::string& file, const std::string& layer, std::optional<Transfer> transfer) {
  const Image image =
      read_linear_image(file, transfer, [&](std::string_view channel) { return layer_needs(layer, channel); });
  try {
    return select_layer(image, layer);
  } catch (const Error& error) {
    throw Error(file, error.what());
  }
}

void say(Terminal& terminal, const ImageDiff& diff) {
  terminal.say(fmt::format("{:<9} {}", "verdict", verdict_name(diff.verdict)));
  for (const std::string& reason : diff.reasons) terminal.say(fmt::format("{:<9} {}", "because", reason));
  say_causes(terminal, diff.causes);
  say_difference(terminal, diff.all);
  if (const auto& eye = diff.perceptual)
    terminal.say(
        fmt::format("{:<9} PSNR {:.2f} dB, SSIM {:.4f}, FLIP {:.4f}, HDR-FLIP {:.4f} ({} exposures, {:+.2f} to "
                    "{:+.2f} stops), Yee {} pixels",
                    "pictures", diff.psnr, eye->displayed.ssim, eye->displayed.flip, eye->hdr_flip,
                    eye->exposures.count, eye->exposures.start, eye->exposures.stop, eye->yee_pixels));
  if (diff.same_seed)
    terminal.warn("voxref: warning: both images were rendered with one seed: their errors are not independent");
}

int diff_images_of(const Options& options, Terminal& terminal) {
  const Image a = read_side(options.a, options.layer_a, options.transfer_a);
  const Image b = read_side(options.b, options.layer_b, options.transfer_b);
  ImageDiffOptions image = options.image;
  if (options.absolute || options.relative) image.limits.tolerance = options.tolerance();
  image.limits.fraction = options.fraction;
  const ImageDiff diff = diff_images(a, b, image);
  say(terminal, diff);
  if (!options.output.empty()) write_image_report(options.output, {a, b, diff, origin(options)});
  return finish(terminal, options, to_json(diff), diff.verdict);
}

// ----------------------------------------------------------------------------------------------------------- volumes

void say(Terminal& terminal, const VolumeDifference& volume, const VolumeLimits& limits) {
  const bool differs = volume.differs(limits);
  if (!volume.problem.empty()) {
    terminal.say(fmt::format("{:<26} {}", volume.entry.name, volume.problem));
    return;
  }
  if (volume.values.differing == 0 && volume.within_envelope == 0) return;
  terminal.say(fmt::format(
      "{:<26} {}: {} of {} values, max {:.4g}{}{}{}", volume.entry.name, differs ? "differs" : "within limits",
      volume.values.differing, volume.values.values, volume.values.max_abs,
      volume.steps > 0 ? fmt::format(" ({:g} steps)", volume.steps) : "",
      volume.occupied_only_a + volume.occupied_only_b
          ? fmt::format(", occupied on one side only {} + {}", volume.occupied_only_a, volume.occupied_only_b)
          : "",
      volume.within_envelope ? fmt::format(", {} texels within the order envelope", volume.within_envelope) : ""));
}

void say_divergence(Terminal& terminal, const VolumeDifference& volume) {
  const VolumeEntry& entry = volume.entry;
  std::string text = fmt::format("{:<9} {} ({})", "diverges", entry.name, entry.stage);
  if (const auto& first = volume.values.first)
    text += fmt::format(" at voxel ({}, {}, {}) channel {}: {:.6g} instead of {:.6g}", first->at.x, first->at.y,
                        first->at.z, first->channel, first->a, first->b);
  terminal.say(text);
}

void say(Terminal& terminal, const FolderDifference& folder) {
  for (const VolumeDifference& volume : folder.volumes) say(terminal, volume, folder.limits);
  if (!folder.grids.empty()) terminal.say("grid      " + folder.grids);
  terminal.say(fmt::format("{:<9} {} ({} volumes)", "verdict", verdict_name(folder.verdict), folder.volumes.size()));
  if (const VolumeDifference* first = folder.first_divergence()) say_divergence(terminal, *first);
}

bool all_finite(const FolderDifference& folder) {
  return std::ranges::all_of(folder.volumes, [](const VolumeDifference& v) { return v.values.nonfinite == 0; });
}

/// Both folders, or one against what voxref makes of its own input, or both of these.
int diff_folders_of(const Options& options, Terminal& terminal) {
  const VolumeLimits limits = options.volume_limits();
  const bool recomputes = !options.scene.file.empty();
  const std::string& reference = options.b.empty() ? options.a : options.b;
  const Progress progress = terminal.progress();
  FolderDifference folder = diff_folders(options.a, reference, limits, progress);
  nlohmann::json result = to_json(folder);
  VolumeReport report{options.a, reference, folder, {}, origin(options)};
  const ScratchFolder work;
  if (recomputes && all_finite(folder)) {
    const Scene scene = load_scene(options.scene, terminal);
    const FolderDifference own =
        recompute(options.a, scene, make_settings(options.settings), options.background, limits, work.path(), progress);
    terminal.say("each stage against voxref on that stage's own input:");
    say(terminal, own);
    result["recomputed"] = to_json(own);
    result["first_divergence"] = result["recomputed"]["first_divergence"];
    if (options.b.empty()) {
      folder = own;
      result.update(result["recomputed"]);
    }
    report.recomputed = own;
  }
  if (!options.b.empty()) {
    if (recomputes) terminal.say("against the reference:");
    report.causes = volume_causes(options.a, options.b, folder, progress);
    say(terminal, folder);
    say_causes(terminal, report.causes);
  }
  result["causes"] = to_json(report.causes);
  if (!options.output.empty()) write_volume_report(options.output, report);
  return finish(terminal, options, result, folder.verdict);
}

int diff_volume_files(const Options& options, Terminal& terminal) {
  const VolumeLimits limits = options.volume_limits();
  ArrayFile a(options.a, 0, ArrayMeaning::volume), b(options.b, 0, ArrayMeaning::volume);
  VolumeEntry entry;
  entry.name = fs::path(options.a).filename().string();
  const VolumeDifference volume = diff_volumes(entry, a, b, limits.tolerance, {}, terminal.progress());
  const Verdict verdict = volume.differs(limits) ? Verdict::different : Verdict::same;
  const bool search = verdict == Verdict::different && volume.values.nonfinite == 0;
  const std::vector<Cause> causes = search ? volume_causes(a, b, limits.tolerance) : std::vector<Cause>();
  terminal.say(fmt::format("{:<9} {}", "verdict", verdict_name(verdict)));
  say(terminal, volume, limits);
  if (volume.differs(limits)) say_divergence(terminal, volume);
  say_causes(terminal, causes);
  nlohmann::json result = to_json(volume, limits);
  result["causes"] = to_json(causes);
  result["first_divergence"] = volume.differs(limits) ? divergence_json(volume) : nlohmann::json();
  return finish(terminal, options, result, verdict);
}

bool is_volume(const std::string& file) {
  return is_array_file(file) && ArrayFile(file, 0, ArrayMeaning::by_shape).shape()[0] > 1;
}

int run_diff(const Options& options) {
  if (!options.output.empty()) require_folder(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const bool folders = fs::is_directory(options.a);
  if (options.b.empty() && (!folders || options.scene.file.empty()))
    throw Error("B", "needed, but not given; only a folder with --recompute goes without");
  if (!options.b.empty() && folders != fs::is_directory(options.b))
    throw Error(folders ? options.b : options.a, "is not a folder of volumes, and the other one is");
  if (!options.scene.file.empty() && !folders) throw Error("--recompute", "takes a folder of volumes");
  if (folders) return diff_folders_of(options, terminal);
  if (is_volume(options.a) || is_volume(options.b)) return diff_volume_files(options, terminal);
  return diff_images_of(options, terminal);
}

// ----------------------------------------------------------------------------------------------------------- options

void add_limits(CLI::App& command, Options& options) {
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
  command.add_flag("--strict", options.strict, "folders: a volume that only one side has is a difference");
}

void add_image_options(CLI::App& command, Options& options) {
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

void add_diff(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("diff", "two images, two volumes or two folders of volumes, compared");
  const auto options = std::make_shared<Options>();
  command->add_option("A", options->a, "the one under test")->required()->type_name("");
  command->add_option("B", options->b, "the reference")->type_name("");
  add_value_option(*command, "-o", "DIR", "writes difference pictures, result.json and report.html",
                   [options](const std::string& text) { options->output = text; });
  add_limits(*command, *options);
  add_image_options(*command, *options);
  add_value_option(*command, "--recompute", "SCENE",
                   "folders: each stage of A also against what voxref computes on that stage's own input",
                   [options](const std::string& text) { options->scene.file = text; });
  add_settings_options(*command, options->settings);
  add_value_option(*command, "--background", "R,G,B", "constant radiance from outside, for --recompute",
                   [options](const std::string& text) {
                     constexpr float largest = 1e18f;
                     options->background = parse_vector("--background", text, 0.0f, largest);
                   });
  add_common_options(*command, options->common);
  command->footer(
      "Exit status: 0 same, 1 different or too noisy to say, 2 could not compare.\n\n"
      "Examples:\n  voxref diff gpu.exr reference.exr -o out/diff\n"
      "  voxref diff dump voxref_volumes --recompute scene.glb --profile villegas2016 --config settings.json");
  on_run(command, run, [options] { return run_diff(*options); });
}

}  // namespace voxref
