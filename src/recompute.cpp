#include "recompute.h"

#include <algorithm>

#include "stages.h"
#include "voxel/npy.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

bool averages_fragments(const Settings& settings) {
  return settings.voxelize.average == VoxelAverage::running_floor8 && settings.storage == Storage::unorm8;
}

/// What is compared, and what has been found so far.
class Recomputation {
 public:
  Recomputation(const VolumeFolder& from, const Scene& scene, const Settings& settings, const VolumeLimits& limits,
                const Progress& progress)
      : from_(from), scene_(scene), settings_(settings), progress_(progress) {
    result_.limits = limits;
  }

  bool has_volume_of(const std::string& stage) const {
    return std::ranges::any_of(from_.entries(),
                               [&](const VolumeEntry& entry) { return stage_making(entry.name) == stage; });
  }
  /// Whether some, but not all, of the levels are there that the bounce gathers from.
  bool lacks_levels() const;
  /// Compares the volumes that a stage makes with those in `recomputed`.
  void compare(const std::string& stage, const fs::path& recomputed);
  /// Lists the volumes of a stage that could not be run. @param why the stage needs what the folder lacks
  void leave_out(const std::string& stage, const std::string& why);
  FolderDifference conclude();

 private:
  VolumeDifference compared(const VolumeEntry& entry, const VolumeEntry& other, const fs::path& recomputed);
  TexelEnvelope envelope_of(const std::string& volume);

  const VolumeFolder& from_;
  const Scene& scene_;
  const Settings& settings_;
  const Progress& progress_;
  FolderDifference result_;
  std::shared_ptr<const std::vector<VoxelEnvelope>> envelopes_;  ///< once needed; null: not yet
};

bool Recomputation::lacks_levels() const {
  const glm::ivec3 size = from_.grid().size;
  size_t present = 0, all = 0;
  for (size_t level = 0; (1 << level) < std::max({size.x, size.y, size.z}); ++level)
    for (size_t face = 0; face < face_names.size(); ++face, ++all) present += from_.has(aniso_name(face, level, false));
  return present > 0 && present < all;
}

TexelEnvelope Recomputation::envelope_of(const std::string& volume) {
  if (!envelopes_)
    envelopes_ = std::make_shared<const std::vector<VoxelEnvelope>>(
        raster_envelopes(scene_, with_box_center(from_.grid(), scene_.bounds(), settings_.grid),
                         settings_.voxelize.static_wins, progress_));
  return texel_envelope(envelopes_, volume);
}

VolumeDifference Recomputation::compared(const VolumeEntry& entry, const VolumeEntry& other,
                                         const fs::path& recomputed) {
  const auto diff = [&](const TexelEnvelope& envelope) {
    return diff_volumes(from_.folder(), entry, recomputed, other, result_.limits.tolerance, envelope, progress_);
  };
  VolumeDifference difference = diff({});
  const bool averaged = entry.name == "albedo" || entry.name == "normal" || entry.name == "emission";
  if (!averaged || !averages_fragments(settings_) || !difference.differs(result_.limits)) return difference;
  return diff(envelope_of(entry.name));
}

void Recomputation::compare(const std::string& stage, const fs::path& recomputed) {
  const VolumeIndex index = read_volume_index(recomputed);
  for (const VolumeEntry& entry : from_.entries()) {
    if (stage_making(entry.name) != stage) continue;
    if (const VolumeEntry* other = index.find(entry.name)) {
      result_.volumes.push_back(compared(entry, *other, recomputed));
    } else if (entry.name == "emission") {  // of a scene without, voxref writes none: its values are 0
      VolumeEntry dark = entry;
      dark.file = "emission.npy";
      dark.mip = 0;
      write_npy(recomputed / dark.file, dark.type, dark.shape, [](size_t, std::span<float>) {});
      result_.volumes.push_back(compared(entry, dark, recomputed));
    } else {
      result_.volumes.push_back(not_compared(entry, "voxref makes no such volume of this grid with these settings"));
      result_.volumes.back().missing = entry.face.empty();  // a level too many is a mistake
    }
  }
}

void Recomputation::leave_out(const std::string& stage, const std::string& why) {
  for (const VolumeEntry& entry : from_.entries())
    if (stage_making(entry.name) == stage) result_.volumes.push_back(not_compared(entry, why));
}

FolderDifference Recomputation::conclude() {
  leave_out("", "made by no stage that voxref knows");
  result_.conclude(index_file(from_.folder()).string());
  return std::move(result_);
}

}  // namespace

FolderDifference recompute(const fs::path& under_test, const Scene& scene, const Settings& settings,
                           const glm::vec3& background, const VolumeLimits& limits, const fs::path& work,
                           const Progress& progress) {
  const VolumeFolder from(under_test);
  Recomputation stages(from, scene, settings, limits, progress);
  const bool surfaces = from.has("albedo") && from.has("normal");
  const bool direct = from.has(radiance_name(false)), bounced = from.has(radiance_name(true));
  const char* unlit = "not judged: the stage that makes it needs albedo and normal, which are not both there";
  if (stages.has_volume_of("voxelize")) {
    run_voxelize(scene, from.grid(), settings, work / "voxelize", progress);
    stages.compare("voxelize", work / "voxelize");
  }
  if (!surfaces) {
    stages.leave_out("shade", unlit);
  } else if (stages.has_volume_of("shade")) {
    run_shade(from, scene, settings, work / "shade", progress);
    stages.compare("shade", work / "shade");
  }
  if (direct || bounced) run_mipmap(from, settings, work / "mipmap", progress);
  const char* unfiltered = "not judged: what it was filtered from is not there";
  direct ? stages.compare("mipmap", work / "mipmap") : stages.leave_out("mipmap", unfiltered);
  if (!surfaces) {
    stages.leave_out("bounce", unlit);
  } else if (!direct) {
    stages.leave_out("bounce", "not judged: there is no radiance to gather");
  } else if (stages.lacks_levels()) {
    stages.leave_out("bounce", "not judged: of the levels that were gathered from some are not there");
  } else if (bounced) {
    run_bounce(from, settings, background, work / "bounce", progress);
    stages.compare("bounce", work / "bounce");
  }
  bounced ? stages.compare("mipmap after bounce", work / "mipmap")
          : stages.leave_out("mipmap after bounce", unfiltered);
  return stages.conclude();
}

}  // namespace voxref
