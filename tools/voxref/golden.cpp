#include <fmt/format.h>

#include <chrono>
#include <set>

#include "commands.h"
#include "compare/diff_report.h"
#include "compare/select_layer.h"
#include "compare/volume_causes.h"
#include "file.h"
#include "golden_cases.h"
#include "image/image_file.h"
#include "json_members.h"
#include "outputs.h"
#include "parallel.h"
#include "parse.h"
#include "provenance.h"
#include "terminal.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

struct Options {
  CommonOptions common;
  std::string action, folder = "golden", scenes, failures = "golden-failures";
  uint64_t seed = golden_seed + 1;
  std::set<std::string> only;  ///< names of cases; empty: all

  fs::path scene_file(const GoldenCase& golden) const {
    return (scenes.empty() ? fs::path(folder) / ".." / "scenes" : fs::path(scenes)) / golden.scene;
  }
  bool wants(const GoldenCase& golden) const { return only.empty() || only.contains(golden.name); }
};

fs::path image_file(const fs::path& folder, const GoldenCase& golden) { return folder / (golden.name + ".exr"); }
fs::path index_of(const fs::path& folder) { return folder / "golden.json"; }

/// The part of a rendered image that the set keeps.
Image kept(const Image& image, const GoldenCase& golden) {
  Image result = select_layer(image, "");
  if (golden.kind == GoldenKind::cone)
    for (const char* layer : {"direct", "diffuse", "specular"}) {
      result.add_layer(layer);
      for (size_t c = 0; c < 3; ++c) std::ranges::copy(image.layer(layer)[c], result.layer(layer)[c].begin());
    }
  return result;
}

/// Renders a path or cone case.
Image render(const GoldenCase& golden, const Scene& scene, uint64_t seed, int spp, const Progress& progress) {
  const Caster caster(scene);
  const View view = golden.view(scene);
  nlohmann::json origin = provenance(scene, view);
  origin["instruction_set"] = instruction_set();
  if (golden.kind == GoldenKind::path) {
    const PathOptions options = golden.path(seed, spp);
    PathResult result = path_trace(scene, caster, view, options, progress);
    if (result.interrupted) throw Interrupted();
    add_path_provenance(origin, options, result.spp);
    Image image = kept(result.image, golden);
    attach(image, origin);
    return image;
  }
  ConeTraceResult result = cone_trace(scene, caster, view, golden.settings(), {}, progress);
  origin["settings"] = to_json(golden.settings());
  Image image = kept(result.image.image, golden);
  attach(image, origin);
  return image;
}

void write_volumes(const GoldenCase& golden, const Scene& scene, const fs::path& folder, const Progress& progress) {
  View view = golden.view(scene);
  view.width = view.height = 1;  // the image is not kept
  cone_trace(scene, Caster(scene), view, golden.settings(), {folder}, progress);
}

// -------------------------------------------------------------------------------------------------------------- make

int run_make(const Options& options) {
  require_folder(options.folder);
  fs::create_directories(options.folder);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  nlohmann::json index = program_provenance();
  index.erase("command_line");  // names folders of the machine that made the set
  index["instruction_set"] = instruction_set();
  index["cases"] = nlohmann::json::array();
  for (const GoldenCase& golden : golden_cases()) {
    const Scene scene = load_gltf(options.scene_file(golden));
    if (options.wants(golden)) {
      if (golden.kind == GoldenKind::volumes) {
        write_volumes(golden, scene, fs::path(options.folder) / golden.name, terminal.progress());
      } else {
        Image image = render(golden, scene, golden_seed, golden_spp, terminal.progress());
        for (const char* key : {"voxref:command_line", "voxref:scene"}) image.attributes.erase(key);
        write_exr(image_file(options.folder, golden), image);
      }
      terminal.say("made      " + golden.name);
    }
    index["cases"].push_back(describe(golden, scene));
  }
  write_text(index_of(options.folder), index.dump(1) + "\n");
  terminal.result({{"folder", options.folder}, {"cases", index["cases"].size()}});
  return exit_done;
}

// ------------------------------------------------------------------------------------------------------------ verify

struct CaseVerdict {
  std::string name;
  Verdict verdict = Verdict::same;
  std::vector<std::string> reasons;
  double seconds = 0.0;
};

/// Limits of path-traced cases. Margins are what the samples of both sides can show, with room below for the noise of
/// the roughest tile; 1 % of the light or 2 % of one material's albedo lie beyond. Of 1000 runs on the same truth one
/// may fail.
NoiseOptions noise_limits(size_t cases) {
  NoiseOptions limits;
  limits.significance = 1e-3 / static_cast<double>(cases);
  limits.margin = 0.005;
  limits.tile_margin = 0.018;
  limits.dark = 0.5;
  limits.tile = 24;
  return limits;
}

/// Limits of cone-traced images: rounding of other instruction sets, which may move a ray across an edge.
ImageLimits cone_limits() {
  ImageLimits limits;
  limits.tolerance = {1e-6, 1e-3};
  limits.fraction = 1e-3;
  return limits;
}

CaseVerdict verify_image(const Options& options, const GoldenCase& golden, const Scene& scene, size_t cases,
                         const Progress& progress) {
  const Image reference = read_image(image_file(options.folder, golden));
  const Image image = render(golden, scene, options.seed, verified_spp, progress);
  ImageDiffOptions judge{.perceptual = false};
  if (golden.kind == GoldenKind::path)
    judge.limits.noise = noise_limits(cases);
  else
    judge.limits = cone_limits();
  CaseVerdict result{golden.name, Verdict::same, {}, 0.0};
  const std::vector<std::string> layers = golden.kind == GoldenKind::path
                                              ? std::vector<std::string>{""}
                                              : std::vector<std::string>{"", "direct", "diffuse", "specular"};
  for (const std::string& layer : layers) {
    const Image a = select_layer(image, layer), b = select_layer(reference, layer);
    const ImageDiff diff = diff_images(a, b, judge);
    if (diff.verdict == Verdict::same) continue;
    result.verdict = diff.verdict;
    for (const std::string& reason : diff.reasons)
      result.reasons.push_back((layer.empty() ? "" : layer + ": ") + reason);
    for (const Cause& cause : diff.causes) result.reasons.push_back("likely cause: " + cause.mistake);
    nlohmann::json origin = program_provenance();
    origin["a"] = "rendered now";
    origin["b"] = image_file(options.folder, golden).string();
    origin["case"] = describe(golden, scene);
    write_image_report(fs::path(options.failures) / golden.name, {a, b, diff, origin});
    break;  // the total first; a layer is told where only it differs
  }
  return result;
}

CaseVerdict verify_volumes(const Options& options, const GoldenCase& golden, const Scene& scene,
                           const Progress& progress) {
  const ScratchFolder work;
  const fs::path rendered = work.path() / golden.name, reference = fs::path(options.folder) / golden.name;
  write_volumes(golden, scene, rendered, progress);
  VolumeLimits limits;
  limits.tolerance = {1e-5, 1e-3};
  limits.strict = true;
  const FolderDifference difference = diff_folders(rendered, reference, limits, progress);
  CaseVerdict result{golden.name, difference.verdict, {}, 0.0};
  if (difference.verdict == Verdict::same) return result;
  if (!difference.grids.empty()) result.reasons.push_back("grids differ: " + difference.grids);
  if (const VolumeDifference* first = difference.first_divergence())
    result.reasons.push_back(fmt::format("first differs in {}, made by {}: {} of {} values", first->entry.name,
                                         first->entry.stage, first->values.differing, first->values.values));
  const std::vector<Cause> causes = volume_causes(rendered, reference, difference, progress);
  for (const Cause& cause : causes) result.reasons.push_back("likely cause: " + cause.mistake);
  nlohmann::json origin = program_provenance();
  origin["case"] = describe(golden, scene);
  write_volume_report(fs::path(options.failures) / golden.name, {rendered, reference, difference, causes, origin});
  return result;
}

CaseVerdict verify(const Options& options, const GoldenCase& golden, const nlohmann::json& index, size_t cases,
                   const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = load_gltf(options.scene_file(golden));
  CaseVerdict result = golden.kind == GoldenKind::volumes ? verify_volumes(options, golden, scene, progress)
                                                          : verify_image(options, golden, scene, cases, progress);
  // A golden of another scene or other settings judges nothing, even where it happens to agree.
  const nlohmann::json now = nlohmann::json::parse(describe(golden, scene).dump());  // numbers as a file holds them
  const auto known =
      std::ranges::find_if(index["cases"], [&](const auto& c) { return c.value("name", "") == golden.name; });
  for (const char* key : {"kind", "scene_sha256", "size", "settings", "seed", "spp", "max_depth"}) {
    if (known != index["cases"].end() && known->value(key, nlohmann::json()) == now.value(key, nlohmann::json()))
      continue;
    result.verdict = Verdict::different;
    result.reasons.push_back(known == index["cases"].end() ? "not in golden.json"
                                                           : fmt::format("the golden was made with another {}", key));
    break;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

int run_verify(const Options& options) {
  require_folder(options.failures);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const nlohmann::json index = read_json(index_of(options.folder));
  if (!index.contains("cases") || !index["cases"].is_array())
    throw Error(index_of(options.folder).string(), "cases", "is missing");
  nlohmann::json cases = nlohmann::json::array();
  int failed = 0;
  for (const GoldenCase& golden : golden_cases()) {
    if (!options.wants(golden)) continue;
    const CaseVerdict result = verify(options, golden, index, golden_cases().size(), terminal.progress());
    failed += result.verdict != Verdict::same;
    terminal.say(fmt::format("{:<32} {} ({:.1f} s)", result.name, verdict_name(result.verdict), result.seconds));
    for (const std::string& reason : result.reasons) terminal.say("  " + reason);
    cases.push_back({{"name", result.name},
                     {"verdict", verdict_name(result.verdict)},
                     {"reasons", result.reasons},
                     {"seconds", result.seconds}});
  }
  if (failed > 0) terminal.say("pictures and reports: " + options.failures);
  terminal.say(fmt::format("{} cases, {} failed", cases.size(), failed));
  terminal.result({{"cases", cases}, {"failed", failed}});
  return failed == 0 ? exit_done : exit_outside_limits;
}

void require_known(const std::set<std::string>& names) {
  for (const std::string& name : names)
    if (std::ranges::none_of(golden_cases(), [&](const GoldenCase& c) { return c.name == name; }))
      throw Error("--case", "there is no case '" + name + "'");
}

}  // namespace

void add_golden(CLI::App& program, Run& run) {
  CLI::App* command =
      program.add_subcommand("golden", "writes the golden set of images and volumes, or renders it again and compares");
  const auto options = std::make_shared<Options>();
  command
      ->add_option_function<std::string>(
          "ACTION",
          [options](const std::string& name) {
            if (name != "make" && name != "verify") throw Error("ACTION", "'" + name + "' is not make or verify");
            options->action = name;
          },
          "make (writes the set) or verify (renders it again, path-traced cases with another seed)")
      ->required()
      ->type_name("");
  command->add_option("DIR", options->folder, "folder of the set (default: golden)")->type_name("");
  add_value_option(*command, "--scenes", "DIR", "folder of the scenes (default: scenes beside the set)",
                   [options](const std::string& text) { options->scenes = text; });
  add_value_option(*command, "-o", "DIR", "verify: where a failed case leaves its report (default: golden-failures)",
                   [options](const std::string& text) { options->failures = text; });
  add_value_option(*command, "--seed", "N", "verify: of path-traced cases", [options](const std::string& text) {
    options->seed = parse_integer("--seed", text, 0, std::numeric_limits<uint64_t>::max());
    if (options->seed == golden_seed) throw Error("--seed", "is the set's own; a fresh one judges it");
  });
  command
      ->add_option_function<std::vector<std::string>>(
          "--case",
          [options](const std::vector<std::string>& names) {
            options->only = {names.begin(), names.end()};
          },
          "only this one (repeatable)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_common_options(*command, options->common);
  command->footer("Exit status: 0 all cases agree, 1 some do not, 2 could not.\n\nExample:\n  voxref golden verify");
  on_run(command, run, [options] {
    require_known(options->only);
    return options->action == "make" ? run_make(*options) : run_verify(*options);
  });
}

}  // namespace voxref
