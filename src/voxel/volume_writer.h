#pragma once
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "voxel/mipmap.h"
#include "voxel/volume_index.h"
#include "voxel/voxelize.h"

namespace voxref {

/// A folder of volumes: volumes.json beside one NumPy .npy file per volume, shape (Z, Y, X, C), dense (cli.md,
/// "Volumes"): albedo (a = opacity), normal, emission, visibility, radiance, radiance_bounce, aniso_<face>_<level>,
/// aniso_bounce_<face>_<level>. Radiance and aniso volumes are premultiplied. In float32 there is centroid (world) too,
/// and emission only where the scene has it. In float16 those of radiance and opacity are float16. In unorm8 volumes
/// are uint8, normals as 0.5 n + 0.5, and static_flag is there; of voxels that count their fragments, albedo, normal
/// and emission have the count as alpha. Files appear whole or not at all, and all of them or none; volumes.json goes
/// away with the first volume that is written and comes back last, so that it never describes a mixture. Volumes pass
/// through memory a slice at a time.
class VolumeFolderWriter {
 public:
  /// Makes the folder, and those above it, where they are missing. @throws Error with the path
  VolumeFolderWriter(std::filesystem::path folder, const Grid& grid, Storage storage = Storage::float32);
  /// Without finish() removes the volumes that it wrote, and the folders that it made unless others use them.
  ~VolumeFolderWriter();
  VolumeFolderWriter(const VolumeFolderWriter&) = delete;
  void write_surfaces(const SurfaceGrid& surfaces);
  /// @param visibility one per voxel of `surfaces`
  void write_visibility(const SurfaceGrid& surfaces, std::span<const float> visibility);
  /// @param radiance one per voxel of `surfaces`, not premultiplied
  /// @param bounced names it radiance_bounce instead of radiance; so below
  void write_radiance(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance, bool bounced);
  template <class Texel>
  void write_levels(const BasicPyramid<Texel>& pyramid, bool bounced);
  /// Writes volumes.json. Nothing that was written counts before.
  void finish();

 private:
  /// @param fill as in write_npy
  void write(const VolumeEntry& entry, const std::function<void(size_t z, std::span<float> slice)>& fill);
  /// A volume of one value per voxel of `surfaces` and zero elsewhere. @param put writes voxel i's channels
  void write_sparse(const VolumeEntry& entry, const SurfaceGrid& surfaces,
                    const std::function<void(size_t i, float* channels)>& put);
  void remove_made_folders() const;
  std::filesystem::path file(const VolumeEntry& entry) const { return folder_ / entry.file; }
  /// Of a volume of attributes, which only unorm8 does not hold in float32.
  VolumeEntry entry(const std::string& name, const glm::ivec3& size, size_t channels, const std::string& stage) const;
  /// Of a volume of radiance and opacity, premultiplied.
  VolumeEntry light_entry(const std::string& name, const glm::ivec3& size, const std::string& stage) const;

  std::filesystem::path folder_;
  Storage storage_;
  std::vector<std::filesystem::path> made_;  // folders that were not there, the innermost first
  VolumeIndex index_;
  bool finished_ = false;
};

}  // namespace voxref
