#pragma once
#include <cstring>
#include <filesystem>
#include <string>

#include "file.h"
#include "make_scenes/builders.h"
#include "pipeline.h"
#include "scene/caster.h"
#include "temporary_folder.h"
#include "voxel/array_file.h"

namespace voxref::testing {

/// The volumes of the Cornell box in the published profile, 16 voxels a side, written into `folder`.
inline Settings small_published_settings() {
  Settings settings = profile("villegas2016");
  settings.grid.resolution = 16;
  return settings;
}
inline Scene small_published_scene() { return cornell_box(CornellLight::point); }

inline void write_published_volumes(const std::filesystem::path& folder) {
  const Scene scene = small_published_scene();
  const Caster caster(scene);
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = 4;
  cone_trace(scene, caster, view, small_published_settings(), {folder});
}

/// Changes a byte of a uint8 volume: the value of a voxel's channel, which is an occupied one's.
struct Tampered {
  glm::ivec3 voxel{0};
  int channel = 0;
};
inline Tampered tamper(const std::filesystem::path& folder, const std::string& volume, int change,
                       bool occupied = true) {
  const std::filesystem::path file = folder / (volume + ".npy");
  Tampered place;
  size_t index = 0;
  {
    ArrayFile array(file, 0, ArrayMeaning::volume);
    const auto [depth, height, width, channels] = array.shape();
    std::vector<float> slice(array.slice_size());
    bool found = false;
    for (size_t z = 0; z < depth && !found; ++z) {
      array.read_slice(z, slice);
      for (size_t i = 0; i < slice.size() && !found; ++i) {
        const size_t texel = i / channels;
        if ((slice[texel * channels + channels - 1] != 0.0f) != occupied) continue;
        found = true;
        place = {{int(texel % width), int(texel / width), int(z)}, int(i % channels)};
        index = z * slice.size() + i;
      }
    }
    const size_t values = depth * slice.size();
    index += std::filesystem::file_size(file) - values;
  }
  std::string bytes = read_file(file);
  bytes[index] = char(uint8_t(bytes[index]) + change);
  write_text(file, bytes);
  return place;
}

}  // namespace voxref::testing
