#include <fmt/format.h>

#include "compare/volume_causes.h"
#include "compare/volume_report.h"
#include "diff_command.h"
#include "file.h"
#include "inputs.h"
#include "recompute.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

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
  std::string text =
      fmt::format("{:<9} {}{}", "diverges", entry.name, entry.stage.empty() ? "" : " (" + entry.stage + ")");
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

void recompute_for(VolumeReport& report, const DiffOptions& options, const fs::path& work, Terminal& terminal) {
  const VolumeLimits limits = options.volume_limits();
  FolderDifference nonfinite = find_nonfinite(options.a, limits, terminal.progress());
  if (const VolumeDifference* broken = nonfinite.first_divergence()) {
    report.not_recomputed = broken->entry.name + ": " + broken->problem;
    terminal.say("not recomputed, for what is not finite leads nowhere: " + report.not_recomputed);
    if (!report.against) report.recomputed = std::move(nonfinite);
    return;
  }
  const Scene scene = load_scene(options.scene, terminal);
  report.recomputed = recompute(options.a, scene, make_settings(options.settings), options.background, limits, work,
                                terminal.progress());
  terminal.say("each stage against voxref on that stage's own input:");
  say(terminal, *report.recomputed);
}

int finish(Terminal& terminal, const DiffOptions& options, const VolumeReport& report) {
  if (report.against && report.recomputed)
    terminal.say(fmt::format("{:<9} {} in all", "verdict", verdict_name(report.verdict())));
  if (!options.output.empty()) write_volume_report(options.output, report);
  return finish_diff(terminal, options, to_json(report), report.verdict());
}

}  // namespace

int diff_folders_of(const DiffOptions& options, Terminal& terminal) {
  VolumeReport report{.title = diff_title(options), .provenance = diff_origin(options)};
  const Progress progress = terminal.progress();
  const ScratchFolder work;  // as long as slices of it may be shown
  if (!options.b.empty()) report.against = diff_folders(options.a, options.b, options.volume_limits(), progress);
  if (!options.scene.file.empty()) recompute_for(report, options, work.path(), terminal);
  if (report.against) {
    if (report.recomputed) terminal.say("against the reference:");
    report.causes = volume_causes(options.a, options.b, *report.against, progress);
    say(terminal, *report.against);
    say_causes(terminal, report.causes);
  }
  return finish(terminal, options, report);
}

int diff_volumes_of(const DiffOptions& options, Terminal& terminal) {
  FolderDifference levels;
  levels.limits = options.volume_limits();
  const std::vector<MipPair> pairs = mip_pairs(options);
  for (const MipPair& mip : pairs) {
    VolumeEntry entry;
    entry.name = fs::path(options.a).stem().string();
    if (pairs.size() > 1) {
      entry.name += fmt::format("_mip{}", mip.a);
      entry.level = mip.a;
    }
    levels.volumes.push_back(
        diff_volumes(entry, {options.a, mip.a}, {options.b, mip.b}, levels.limits.tolerance, {}, terminal.progress()));
  }
  levels.conclude(options.a);
  VolumeReport report{.title = diff_title(options), .against = levels, .provenance = diff_origin(options)};
  if (const VolumeDifference* first = levels.first_divergence(); first && first->values.nonfinite == 0) {
    ArrayFile a = first->a.open(), b = first->b.open();
    report.causes = volume_causes(a, b, levels.limits.tolerance, terminal.progress());
  }
  say(terminal, levels);
  say_causes(terminal, report.causes);
  return finish(terminal, options, report);
}

}  // namespace voxref
