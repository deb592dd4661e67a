#pragma once
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "voxel/array_file.h"
#include "voxel/mipmap.h"
#include "voxel/volume_index.h"
#include "voxel/volume_writer.h"
#include "voxel/voxelize.h"

namespace voxref {

/// Opens a volume's file and holds it against its entry. @throws Error with the file and what is wrong
ArrayFile open_volume(const std::filesystem::path& folder, const VolumeEntry& entry);

/// Reads a folder of volumes (see VolumeFolderWriter), whoever wrote it, in whichever format ArrayFile reads. Every
/// read checks shape, type and finiteness. @throws Error with the file and what is wrong
class VolumeFolder {
 public:
  explicit VolumeFolder(std::filesystem::path folder);
  const std::filesystem::path& folder() const { return folder_; }
  const Grid& grid() const { return index_.grid; }
  const std::vector<VolumeEntry>& entries() const { return index_.volumes; }
  bool has(const std::string& volume) const { return index_.find(volume) != nullptr; }
  /// Voxels whose albedo's alpha is above zero; where alpha counts fragments the opacity is 1. Without a centroid
  /// volume the voxel centres stand in, and an emission volume without light is left out.
  SurfaceGrid surfaces() const;
  /// radiance or radiance_bounce at the surfaces' voxels, not premultiplied.
  std::vector<glm::vec3> radiance(const SurfaceGrid& surfaces, bool bounced) const;
  /// Mean visibility of the lights at the surfaces' voxels.
  std::vector<float> visibility(const SurfaceGrid& surfaces) const;
  /// radiance or radiance_bounce, premultiplied, whichever way it is stored.
  template <class Texel = glm::vec4>
  BrickVolume<Texel> base(bool bounced) const;
  /// Base and all levels; the levels as they are in the folder, not recomputed.
  template <class Texel = glm::vec4>
  BasicPyramid<Texel> pyramid(bool bounced) const;

 private:
  /// Opens a volume and holds it against its entry and the size that its place in the pipeline asks for.
  ArrayFile open(const VolumeEntry& entry, const glm::ivec3& size, size_t least_channels) const;
  template <class Texel>
  BrickVolume<Directional<Texel>> level(size_t level, const glm::ivec3& size, bool bounced) const;
  const VolumeEntry& entry(const std::string& name) const;
  std::string file(const VolumeEntry& entry) const;
  /// Calls get(i, texel) with the texel of each of the surfaces' voxels.
  void read_sparse(const VolumeEntry& entry, const SurfaceGrid& surfaces, size_t least_channels,
                   const std::function<void(size_t i, std::span<const float> texel)>& get) const;

  std::filesystem::path folder_;
  VolumeIndex index_;
};

}  // namespace voxref
