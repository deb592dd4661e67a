#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "file.h"
#include "scene/gltf.h"
#include "settings.h"
#include "voxel/volume_file.h"

namespace voxref {

/// One configuration of the published shaders' output: shared/gpu/<name>.
struct GpuCase {
  explicit GpuCase(const std::filesystem::path& where)
      : folder(where), scene(load_gltf(where / "scene.glb")), volumes(where / "volumes") {
    apply_json(settings, nlohmann::json::parse(read_file((where / "settings.json").string())));
  }
  Grid grid() const { return fit_grid(scene.bounds(), settings.grid); }

  std::filesystem::path folder;
  Settings settings;
  Scene scene;
  VolumeFolder volumes;
};

/// Where two volumes differ: how many texels, by how much at most, and the first.
struct TexelDifferences {
  size_t texels = 0;
  int largest = 0;
  std::string first;
};

/// Holds a .npy file of bytes against another. @param channels per texel
inline TexelDifferences difference(const std::filesystem::path& ours, const std::filesystem::path& theirs) {
  ArrayFile a(ours), b(theirs);
  TexelDifferences result;
  if (a.shape() != b.shape() || a.type() != ElementType::uint8 || b.type() != ElementType::uint8) {
    result.texels = a.slice_size();
    result.first = "another shape or type";
    return result;
  }
  const size_t width = a.shape()[2], channels = a.shape()[3];
  std::vector<float> slice_a(a.slice_size()), slice_b(b.slice_size());
  for (size_t z = 0; z < a.shape()[0]; ++z) {
    a.read_slice(z, slice_a);
    b.read_slice(z, slice_b);
    for (size_t texel = 0; texel < slice_a.size() / channels; ++texel) {
      int largest = 0;
      for (size_t c = texel * channels; c < (texel + 1) * channels; ++c)
        largest = std::max(largest, int(std::lround(255.0f * std::abs(slice_a[c] - slice_b[c]))));
      if (largest == 0) continue;
      if (result.texels++ == 0) result.first = fmt::format("voxel ({}, {}, {})", texel % width, texel / width, z);
      result.largest = std::max(result.largest, largest);
    }
  }
  return result;
}

}  // namespace voxref
