#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
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

/// How one volume under test differs from its reference. Texels count as occupied where their last channel is not zero.
struct VolumeDifference {
  VolumeEntry entry;     ///< of the one under test, or of the reference where only that is there
  std::string problem;   ///< why values cannot be compared: there on one side only, shapes differ; empty: they were
  bool missing = false;  ///< only one side has it
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
VolumeDifference diff_volumes(const VolumeEntry& entry, ArrayFile& a, ArrayFile& b, const Tolerance& tolerance,
                              const TexelEnvelope& envelope = {}, const Progress& progress = {});

/// What the envelopes accept in `albedo`, `normal` or `emission`. @throws Error for another name
TexelEnvelope texel_envelope(std::vector<VoxelEnvelope> envelopes, const std::string& volume);

/// Two folders of volumes, those of both in the order of the pipeline.
struct FolderDifference {
  Verdict verdict = Verdict::same;
  VolumeLimits limits;
  std::string grids;  ///< how dims or bounds differ; empty: not
  std::vector<VolumeDifference> volumes;

  /// The first volume that differs: where the pipeline first went wrong. Null: none.
  const VolumeDifference* first_divergence() const;
};

/// @param a under test @param b reference
FolderDifference diff_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                              const VolumeLimits& limits, const Progress& progress = {});

/// Position of the stage that makes a volume in the pipeline: voxelize 0, shade 1, mipmap 2, bounce 3, mipmap after
/// bounce 4; volumes of other stages come last.
int stage_rank(const VolumeEntry& entry);

/// {stage, volume, face, level, voxel [x,y,z], channel, a, b}: where a volume first differs.
nlohmann::json divergence_json(const VolumeDifference& volume);
nlohmann::json to_json(const VolumeDifference& volume, const VolumeLimits& limits);
/// The keys of cli.md, summed over the volumes, first_divergence and per_volume.
nlohmann::json to_json(const FolderDifference& folder);

}  // namespace voxref
