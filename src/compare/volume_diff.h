#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/difference.h"
#include "compare/noise_verdict.h"
#include "progress.h"
#include "voxel/array_file.h"
#include "voxel/average_envelope.h"
#include "voxel/volume_index.h"

namespace voxref {

struct VolumeLimits {
  Tolerance tolerance{};
  double fraction = 0.0;  ///< of a volume's values that may be over the tolerance
  bool strict = false;    ///< volumes that only one side has make them different
};

/// Where a volume lies: a level of detail of an array file.
struct VolumeSource {
  std::filesystem::path file;
  int mip = 0;

  ArrayFile open() const { return ArrayFile(file, mip, ArrayMeaning::volume); }
};

/// How one volume under test differs from its reference. Texels count as occupied where their last channel is not zero.
struct VolumeDifference {
  VolumeEntry entry;     ///< of the one under test, or of the reference where only that is there
  std::string problem;   ///< why values were not compared: there on one side only, shapes differ; empty: they were
  bool missing = false;  ///< only one side has it, or it could not be judged
  VolumeSource a, b;     ///< where values were compared
  Difference values;
  uint64_t occupied_a = 0, occupied_b = 0;            ///< texels
  uint64_t occupied_only_a = 0, occupied_only_b = 0;  ///< texels
  double steps = 0.0;  ///< largest |a - b| in units of the last place of the coarser storage: bytes or halves; else 0
  uint64_t within_envelope =
      0;  ///< texels that differ, as another order of averaging might make them: they do not count

  bool differs(const VolumeLimits& limits) const;
};

/// What else than equal values is right in a volume of averaged fragments: true where another order of averaging gives
/// the texel, count included. See average_envelope.h. @param texel uint8 values x (1/255), four channels
using TexelEnvelope = std::function<bool(const glm::ivec3& voxel, std::span<const float> texel)>;

/// Compares two volumes, a slice of each in memory at a time.
VolumeDifference diff_volumes(const VolumeEntry& entry, const VolumeSource& a, const VolumeSource& b,
                              const Tolerance& tolerance, const TexelEnvelope& envelope = {},
                              const Progress& progress = {});
/// The same for volumes of two folders, each held against its own entry first. @throws Error with the file
VolumeDifference diff_volumes(const std::filesystem::path& folder_a, const VolumeEntry& a,
                              const std::filesystem::path& folder_b, const VolumeEntry& b, const Tolerance& tolerance,
                              const TexelEnvelope& envelope = {}, const Progress& progress = {});

/// A volume that was not compared with another.
VolumeDifference not_compared(const VolumeEntry& entry, const std::string& why);

/// What the envelopes, sorted as the file is, accept in `albedo`, `normal` or `emission`. @throws Error for another
/// name
TexelEnvelope texel_envelope(std::shared_ptr<const std::vector<VoxelEnvelope>> envelopes, const std::string& volume);

/// Two folders of volumes, those of both in the order of the pipeline.
struct FolderDifference {
  Verdict verdict = Verdict::same;
  VolumeLimits limits;
  std::string grids;  ///< how dims or bounds differ; empty: not
  std::vector<VolumeDifference> volumes;

  /// The first volume that differs: where the pipeline first went wrong. Null: none.
  const VolumeDifference* first_divergence() const;
  /// Puts the volumes into the order of the pipeline, and says what comes of them.
  /// @param whose for the error @throws Error where none of the volumes was compared: that is no agreement
  void conclude(const std::string& whose);
};

/// @param a under test @param b reference
/// @throws Error where a file cannot be read, or the folders have no volume in common
FolderDifference diff_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                              const VolumeLimits& limits, const Progress& progress = {});

/// Looks through all volumes of a folder: those that hold NaN or infinity differ, the first such place is told.
FolderDifference find_nonfinite(const std::filesystem::path& folder, const VolumeLimits& limits,
                                const Progress& progress = {});

/// Position of the stage that makes a volume in the pipeline: voxelize 0, shade 1, mipmap 2, bounce 3, mipmap after
/// bounce 4; volumes of other stages come last.
int stage_rank(const VolumeEntry& entry);

/// {stage, volume, face, level, voxel [x,y,z], channel, a, b}: where a volume first differs.
nlohmann::json divergence_json(const VolumeDifference& volume);
nlohmann::json to_json(const VolumeDifference& volume, const VolumeLimits& limits);
/// The keys of cli.md, summed over the volumes, first_divergence and per_volume.
nlohmann::json to_json(const FolderDifference& folder);

}  // namespace voxref
