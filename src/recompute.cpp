#include "recompute.h"

#include <algorithm>

#include "stages.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

/// What is compared, and what has been found so far.
struct Work {
  const VolumeFolder& from;
  const Scene& scene;
  const Settings& settings;
  const VolumeLimits& limits;
  const Progress& progress;
  FolderDifference result;

  bool has_stage(const std::string& stage) const {
    return std::ranges::any_of(from.entries(), [&](const VolumeEntry& e) { return e.stage == stage; });
  }
  /// Compares the volumes of one stage with those in `recomputed`.
  void compare(const std::string& stage, const fs::path& recomputed);
  VolumeDifference within_envelope(const VolumeEntry& entry, const VolumeEntry& other,
                                   const fs::path& recomputed) const;
};

bool averages_fragments(const Settings& settings) {
  return settings.voxelize.method == VoxelizeMethod::raster && settings.storage == Storage::unorm8;
}

VolumeDifference Work::within_envelope(const VolumeEntry& entry, const VolumeEntry& other,
                                       const fs::path& recomputed) const {
  const TexelEnvelope envelope =
      texel_envelope(raster_envelopes(scene, with_box_center(from.grid(), scene.bounds(), settings.grid),
                                      settings.voxelize.static_wins, progress),
                     entry.name);
  ArrayFile a = open_volume(from.folder(), entry), b = open_volume(recomputed, other);
  return diff_volumes(entry, a, b, limits.tolerance, envelope, progress);
}

void Work::compare(const std::string& stage, const fs::path& recomputed) {
  const VolumeIndex index = read_volume_index(recomputed);
  for (const VolumeEntry& entry : from.entries()) {
    const VolumeEntry* other = index.find(entry.name);
    if (entry.stage != stage || !other) continue;
    ArrayFile a = open_volume(from.folder(), entry), b = open_volume(recomputed, *other);
    VolumeDifference difference = diff_volumes(entry, a, b, limits.tolerance, {}, progress);
    const bool averaged = entry.name == "albedo" || entry.name == "normal" || entry.name == "emission";
    if (averaged && averages_fragments(settings) && difference.differs(limits))
      difference = within_envelope(entry, *other, recomputed);
    result.volumes.push_back(std::move(difference));
  }
}

}  // namespace

FolderDifference recompute(const fs::path& under_test, const Scene& scene, const Settings& settings,
                           const glm::vec3& background, const VolumeLimits& limits, const fs::path& work,
                           const Progress& progress) {
  const VolumeFolder from(under_test);
  Work stages{from, scene, settings, limits, progress, {}};
  stages.result.limits = limits;
  if (stages.has_stage("voxelize")) {
    run_voxelize(scene, from.grid(), settings, work / "voxelize", progress);
    stages.compare("voxelize", work / "voxelize");
  }
  if (stages.has_stage("shade") && from.has("albedo")) {
    run_shade(from, scene, settings, work / "shade", progress);
    stages.compare("shade", work / "shade");
  }
  if (from.has(radiance_name(false)) || from.has(radiance_name(true))) {
    run_mipmap(from, settings, work / "mipmap", progress);
    stages.compare("mipmap", work / "mipmap");
  }
  if (stages.has_stage("bounce") && from.has("albedo") && from.has(radiance_name(false))) {
    run_bounce(from, settings, background, work / "bounce", progress);
    stages.compare("bounce", work / "bounce");
    stages.compare("mipmap after bounce", work / "mipmap");
  }
  if (stages.result.first_divergence()) stages.result.verdict = Verdict::different;
  return stages.result;
}

}  // namespace voxref
