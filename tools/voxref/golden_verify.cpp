#include <fmt/format.h>

#include <chrono>

#include "commands.h"
#include "compare/image_report.h"
#include "compare/select_layer.h"
#include "compare/volume_causes.h"
#include "compare/volume_report.h"
#include "file.h"
#include "golden_command.h"
#include "image/image_file.h"
#include "parallel.h"
#include "provenance.h"
#include "terminal.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

struct CaseVerdict {
  std::string name;
  Verdict verdict = Verdict::same;
  std::vector<std::string> reasons{};
  bool has_report = false;  ///< pictures and a page were written
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

CaseVerdict verify_image(const GoldenOptions& options, const GoldenCase& golden, const Scene& scene, size_t cases,
                         const Progress& progress) {
  const std::string file = options.image_file(golden).string();
  const Image reference = read_image(file);
  if (reference.width() != golden.side || reference.height() != golden.side)
    return {
        golden.name,
        Verdict::different,
        {fmt::format("{} is {}x{}, not {}x{}", file, reference.width(), reference.height(), golden.side, golden.side)}};
  const Image image = render_golden(golden, scene, options.seed, verified_spp, progress);
  ImageDiffOptions judge{.perceptual = false};
  if (golden.kind == GoldenKind::path)
    judge.limits.noise = noise_limits(cases);
  else
    judge.limits = cone_limits();
  CaseVerdict result{.name = golden.name};
  const std::vector<std::string> layers = golden.kind == GoldenKind::path
                                              ? std::vector<std::string>{""}
                                              : std::vector<std::string>{"", "direct", "diffuse", "specular"};
  for (const std::string& layer : layers) {
    const Image a = select_layer(image, layer), b = select_layer(reference, layer);
    const ImageDiff diff = diff_images(a, b, judge, progress);
    if (diff.verdict == Verdict::same) continue;
    result.verdict = diff.verdict;
    for (const std::string& reason : diff.reasons)
      result.reasons.push_back((layer.empty() ? "" : layer + ": ") + reason);
    for (const Cause& cause : diff.causes) result.reasons.push_back("likely cause: " + cause.mistake);
    nlohmann::json origin = program_provenance();
    origin["a"] = "rendered now";
    origin["b"] = file;
    origin["case"] = describe(golden, scene);
    write_image_report(fs::path(options.failures) / golden.name, {a, b, diff, to_json(diff), origin});
    result.has_report = true;
    break;  // the total first; a layer is told where only it differs
  }
  return result;
}

CaseVerdict verify_volumes(const GoldenOptions& options, const GoldenCase& golden, const Scene& scene,
                           const Progress& progress) {
  const ScratchFolder work;
  const fs::path rendered = work.path() / golden.name, reference = options.volume_folder(golden);
  write_golden_volumes(golden, scene, rendered, progress);
  VolumeLimits limits;
  limits.strict = true;
  const FolderDifference difference = diff_folders(rendered, reference, limits, progress);
  CaseVerdict result{.name = golden.name, .verdict = difference.verdict};
  if (difference.verdict == Verdict::same) return result;
  if (!difference.grids.empty()) result.reasons.push_back("grids differ: " + difference.grids);
  if (const VolumeDifference* first = difference.first_divergence())
    result.reasons.push_back(fmt::format("first differs in {}, made by {}: {} of {} values", first->entry.name,
                                         first->entry.stage, first->values.differing, first->values.values));
  const std::vector<Cause> causes = volume_causes(rendered, reference, difference, progress);
  for (const Cause& cause : causes) result.reasons.push_back("likely cause: " + cause.mistake);
  nlohmann::json origin = program_provenance();
  origin["case"] = describe(golden, scene);
  write_volume_report(fs::path(options.failures) / golden.name,
                      {.title = golden.name + " rendered now against the golden",
                       .against = difference,
                       .causes = causes,
                       .provenance = origin});
  result.has_report = true;
  return result;
}

/// Why what the set says of a case is not how the case is rendered now; empty: it is. A golden of another scene or
/// other settings judges nothing, even where it happens to agree.
std::string index_mismatch(const std::map<std::string, nlohmann::json>& index, const GoldenCase& golden,
                           const Scene& scene) {
  const auto known = index.find(golden.name);
  if (known == index.end()) return "not in golden.json";
  const nlohmann::json now = nlohmann::json::parse(describe(golden, scene).dump());  // numbers as a file holds them
  for (const char* key : {"kind", "scene_sha256", "size", "settings", "seed", "spp", "max_depth"})
    if (known->second.value(key, nlohmann::json()) != now.value(key, nlohmann::json()))
      return fmt::format("the golden was made with another {}", key);
  return "";
}

CaseVerdict verify(const GoldenOptions& options, const GoldenCase& golden,
                   const std::map<std::string, nlohmann::json>& index, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = load_gltf(options.scene_file(golden));
  const std::string mismatch = index_mismatch(index, golden, scene);
  CaseVerdict result = golden.kind == GoldenKind::volumes
                           ? verify_volumes(options, golden, scene, progress)
                           : verify_image(options, golden, scene, golden_cases().size(), progress);
  if (!mismatch.empty()) {
    result.verdict = Verdict::different;
    result.reasons.insert(result.reasons.begin(), mismatch);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace

int verify_goldens(const GoldenOptions& options) {
  require_folder(options.failures);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const std::map<std::string, nlohmann::json> index = read_golden_index(options.index_file());
  nlohmann::json cases = nlohmann::json::array();
  int failed = 0, reports = 0;
  for (const GoldenCase& golden : golden_cases()) {
    if (!options.wants(golden)) continue;
    const CaseVerdict result = verify(options, golden, index, terminal.progress());
    failed += result.verdict != Verdict::same;
    reports += result.has_report;
    terminal.say(fmt::format("{:<32} {} ({:.1f} s)", result.name, verdict_name(result.verdict), result.seconds));
    for (const std::string& reason : result.reasons) terminal.say("  " + reason);
    cases.push_back({{"name", result.name},
                     {"verdict", verdict_name(result.verdict)},
                     {"reasons", result.reasons},
                     {"seconds", result.seconds}});
  }
  if (reports > 0) terminal.say("pictures and reports: " + options.failures);
  terminal.say(fmt::format("{} cases, {} failed", cases.size(), failed));
  terminal.result({{"cases", cases}, {"failed", failed}});
  return failed == 0 ? exit_done : exit_outside_limits;
}

}  // namespace voxref
