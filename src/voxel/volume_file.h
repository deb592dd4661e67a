#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "voxel/mipmap.h"
#include "voxel/voxelize.h"

namespace voxref {

/// A folder of volumes: volumes.json beside one NumPy .npy file per volume, shape (Z, Y, X, C), float32, dense (cli.md,
/// "Volumes"). The radiometric profile writes albedo (a = opacity), normal, centroid (world), emission where the scene
/// has it, radiance, radiance_bounce, aniso_<face>_<level>, aniso_bounce_<face>_<level>. Radiance and aniso volumes are
/// premultiplied. Files appear whole or not at all; volumes.json is written last.
class VolumeFolderWriter {
 public:
  VolumeFolderWriter(std::filesystem::path folder, const Grid& grid);
  void write_surfaces(const SurfaceGrid& surfaces);
  /// @param bounced names them radiance_bounce and aniso_bounce_* instead of radiance and aniso_*
  void write_radiance(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance, bool bounced);
  void write_base(const BrickVolume<glm::vec4>& base, bool bounced);
  void write_levels(const Pyramid& pyramid, bool bounced);
  /// Writes volumes.json. Nothing that was written counts before.
  void finish();

 private:
  struct Entry;
  std::filesystem::path folder_;
  Grid grid_;
  std::vector<Entry> entries_;
};

/// Reads such a folder, whoever wrote it. Every read checks shape, type and finiteness.
/// @throws Error with the file and what is wrong
class VolumeFolder {
 public:
  explicit VolumeFolder(std::filesystem::path folder);
  const Grid& grid() const { return grid_; }
  bool has(const std::string& volume) const;
  /// Voxels whose albedo's alpha is above zero. Without a centroid volume the voxel centres stand in.
  SurfaceGrid surfaces() const;
  /// radiance or radiance_bounce at the surfaces' voxels, not premultiplied.
  std::vector<glm::vec3> radiance(const SurfaceGrid& surfaces, bool bounced) const;
  BrickVolume<glm::vec4> base(bool bounced) const;
  /// Base and all levels; the levels as they are in the folder, not recomputed.
  Pyramid pyramid(bool bounced) const;

 private:
  std::filesystem::path folder_;
  Grid grid_;
};

}  // namespace voxref
