#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "voxel/array_layout.h"
#include "voxel/grid.h"

namespace voxref {

/// One volume of a folder, as its volumes.json describes it.
struct VolumeEntry {
  std::string name;
  std::string file;               ///< in the folder, or below it; name.npy where volumes.json names none
  int mip = 0;                    ///< level of detail in the file
  std::array<size_t, 4> shape{};  ///< Z, Y, X, C
  ElementType type = ElementType::float32;
  std::string stage;           ///< that made it: voxelize, shade, mipmap, bounce, "mipmap after bounce"; empty: unknown
  std::string face;            ///< one of face_names; empty: none
  int level = -1;              ///< mip level, 0 at half the base resolution; -1: none
  bool premultiplied = false;  ///< rgb is already multiplied by alpha
  std::string alpha;           ///< what the fourth channel means; empty: opacity, or there is none
  std::string encoding;        ///< of values that are not stored plainly; empty: plain
};

/// A folder of volumes: cli.md, "Volumes".
struct VolumeIndex {
  Grid grid;
  std::string format = "float32";  ///< float16, unorm8: how the renderer that made the volumes holds them
  std::vector<VolumeEntry> volumes;

  const VolumeEntry* find(const std::string& name) const;  ///< null when there is none
};

inline constexpr const char* signed_bytes = "0.5 n + 0.5";  ///< encoding of normals in unorm8

/// radiance, or radiance_bounce after bounces.
std::string radiance_name(bool bounced);
/// aniso_<face>_<level> or aniso_bounce_<face>_<level>. @param face index into face_names
std::string aniso_name(size_t face, size_t level, bool bounced);

/// The stage that makes a volume of this name, as cli.md calls them; empty: none does.
std::string stage_making(const std::string& volume);

std::filesystem::path index_file(const std::filesystem::path& folder);

/// Writes folder/volumes.json. @throws Error with the path
void write_volume_index(const std::filesystem::path& folder, const VolumeIndex& index);

/// Reads folder/volumes.json, whoever wrote it. Keys that it does not know are ignored; stage, face and level follow
/// from a volume's name where they are not given.
/// @throws Error `FILE: PLACE: what is wrong`
VolumeIndex read_volume_index(const std::filesystem::path& folder);

}  // namespace voxref
