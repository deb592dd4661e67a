#include <fmt/format.h>

#include "commands.h"
#include "compare/image_report.h"
#include "compare/report_parts.h"
#include "diff_command.h"
#include "outputs.h"
#include "parallel.h"
#include "provenance.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

bool is_volume(const DiffOptions& options, const std::string& file) {
  const ArrayMeaning meaning = options.volume ? ArrayMeaning::volume : ArrayMeaning::by_shape;
  return is_array_file(file) && (options.volume || ArrayFile(file, 0, meaning).shape()[0] > 1);
}

/// Limits that nothing would be held against are refused: they would seem to be kept.
void require_limits_apply(const DiffOptions& options, bool images) {
  const ImageLimits& limits = options.image.limits;
  if (!images && limits.by_metrics()) throw Error("limits on metrics", "are for images, and these are volumes");
  const auto refuse = [&](const char* flag, const std::optional<double>& limit) {
    if (limit && !options.image.perceptual) throw Error("--fast", std::string("leaves out what ") + flag + " limits");
  };
  refuse("--max-flip", limits.flip);
  refuse("--max-hdr-flip", limits.hdr_flip);
  refuse("--min-ssim", limits.ssim);
}

void require_inputs_kept(const DiffOptions& options) {
  if (options.output.empty()) return;
  NamedFiles files{options.scene.file, options.settings.config, {}, std::nullopt, {options.a, options.b}};
  for (const std::string_view name : image_report_files) files.written.push_back(fs::path(options.output) / name);
  require_no_clash(files);
}

int run_diff(const DiffOptions& options) {
  const bool folders = fs::is_directory(options.a);
  if (options.b.empty() && (!folders || options.scene.file.empty()))
    throw Error("B", "needed, but not given; only a folder with --recompute goes without");
  if (!options.b.empty() && folders != fs::is_directory(options.b))
    throw Error(folders ? options.b : options.a, "is not a folder of volumes, and the other one is");
  if (!options.scene.file.empty() && !folders) throw Error("--recompute", "takes a folder of volumes");
  const bool volumes = folders || is_volume(options, options.a) || is_volume(options, options.b);
  require_limits_apply(options, !volumes);
  if (!options.output.empty()) require_folder(options.output);
  require_inputs_kept(options);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  if (folders) return diff_folders_of(options, terminal);
  return volumes ? diff_volumes_of(options, terminal) : diff_images_of(options, terminal);
}

}  // namespace

nlohmann::json diff_origin(const DiffOptions& options) {
  nlohmann::json provenance = program_provenance();
  provenance["a"] = options.a;
  provenance["b"] = options.b;
  return provenance;
}

std::string diff_title(const DiffOptions& options) {
  return name_of(options.a) + " against " + (options.b.empty() ? "voxref" : name_of(options.b));
}

std::vector<MipPair> mip_pairs(const DiffOptions& options) {
  const auto levels = [](const std::string& file) { return is_array_file(file) ? ArrayFile(file).mip_count() : 1; };
  const int a = levels(options.a), b = levels(options.b);
  if (options.mip) return {{a > 1 ? *options.mip : 0, b > 1 ? *options.mip : 0}};
  if (a != b)
    throw Error(options.a, fmt::format("mip levels: {}, and {} has {}; --mip compares one of them", a, options.b, b));
  std::vector<MipPair> pairs;
  for (int level = 0; level < a; ++level) pairs.push_back({level, level});
  return pairs;
}

void say_causes(Terminal& terminal, const std::vector<Cause>& causes) {
  for (const Cause& cause : causes) terminal.say(fmt::format("{:<9} {}", "cause", cause.mistake));
}

int finish_diff(Terminal& terminal, const DiffOptions& options, const nlohmann::json& result, Verdict verdict) {
  if (!options.output.empty()) terminal.say("report    " + (fs::path(options.output) / "report.html").string());
  terminal.result(result);
  return verdict == Verdict::same ? exit_done : exit_outside_limits;
}

void add_diff(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("diff", "two images, two volumes or two folders of volumes, compared");
  const auto options = std::make_shared<DiffOptions>();
  add_diff_options(*command, options);
  command->footer(
      "Exit status: 0 same, 1 different or too noisy to say, 2 could not compare.\n\n"
      "Examples:\n  voxref diff gpu.exr reference.exr -o out/diff\n"
      "  voxref diff dump voxref_volumes --recompute scene.glb --profile villegas2016 --config settings.json");
  on_run(command, run, [options] { return run_diff(*options); });
}

}  // namespace voxref
