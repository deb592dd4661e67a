#include "voxel/volume_writer.h"

#include <algorithm>
#include <cassert>

#include "error.h"
#include "voxel/npy.h"

namespace voxref {

namespace {

void store(const glm::vec3& v, float* channels) { std::copy_n(&v.x, 3, channels); }
void store(const glm::vec4& v, float* channels) { std::copy_n(&v.x, 4, channels); }

/// Slice z of a brick volume. @param value picks what to write of a texel
template <class Texel, class Value>
void fill_slice(const BrickVolume<Texel>& volume, int z, std::span<float> slice, Value&& value) {
  float* channels = slice.data();
  for (int y = 0; y < volume.size().y; ++y)
    for (int x = 0; x < volume.size().x; ++x, channels += 4) store(to_vec4(decode(value(volume({x, y, z})))), channels);
}

constexpr const char* counted = "count of averaged fragments, modulo 256";

}  // namespace

VolumeFolderWriter::VolumeFolderWriter(std::filesystem::path folder, const Grid& grid, Storage storage)
    : folder_(std::move(folder)), storage_(storage) {
  std::error_code error;
  for (std::filesystem::path missing = folder_; !missing.empty() && !std::filesystem::exists(missing, error);
       missing = missing.parent_path())
    made_.push_back(missing);
  std::filesystem::create_directories(folder_, error);
  if (error) {
    remove_made_folders();
    throw Error(folder_.string(), "cannot be made: " + error.message());
  }
  index_.grid = grid;
  index_.format = storage_names[size_t(storage)];
}

VolumeFolderWriter::~VolumeFolderWriter() {
  if (finished_) return;
  std::error_code ignored;  // what cannot be removed stays; there is an error on its way already
  for (const VolumeEntry& entry : index_.volumes) std::filesystem::remove(file(entry), ignored);
  remove_made_folders();
}

/// Only empty folders can be removed: what others put there stays.
void VolumeFolderWriter::remove_made_folders() const {
  std::error_code ignored;
  for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, ignored);
}

VolumeEntry VolumeFolderWriter::entry(const std::string& name, const glm::ivec3& size, size_t channels,
                                      const std::string& stage) const {
  VolumeEntry entry;
  entry.name = name;
  entry.file = name + ".npy";
  entry.shape = {size_t(size.z), size_t(size.y), size_t(size.x), channels};
  entry.type = storage_ == Storage::unorm8 ? ElementType::uint8 : ElementType::float32;
  entry.stage = stage;
  if (channels == 4) entry.alpha = "opacity";
  return entry;
}

VolumeEntry VolumeFolderWriter::light_entry(const std::string& name, const glm::ivec3& size,
                                            const std::string& stage) const {
  VolumeEntry volume = entry(name, size, 4, stage);
  if (storage_ == Storage::float16) volume.type = ElementType::float16;
  volume.premultiplied = true;
  return volume;
}

void VolumeFolderWriter::write(const VolumeEntry& entry,
                               const std::function<void(size_t z, std::span<float> slice)>& fill) {
  if (index_.volumes.empty()) {
    std::error_code error;
    std::filesystem::remove(index_file(folder_), error);
    if (error) throw Error(index_file(folder_).string(), "cannot be replaced: " + error.message());
  }
  write_npy(file(entry), entry.type, entry.shape, fill);
  index_.volumes.push_back(entry);
}

void VolumeFolderWriter::write_sparse(const VolumeEntry& entry, const SurfaceGrid& surfaces,
                                      const std::function<void(size_t i, float* channels)>& put) {
  assert(surfaces.grid.size == index_.grid.size);
  size_t i = 0;  // voxels are sorted as the file is
  write(entry, [&](size_t z, std::span<float> slice) {
    for (; i < surfaces.size() && size_t(surfaces.voxels[i].z) == z; ++i) {
      const glm::ivec3& v = surfaces.voxels[i];
      put(i, slice.data() + entry.shape[3] * (size_t(v.x) + entry.shape[2] * size_t(v.y)));
    }
  });
}

void VolumeFolderWriter::write_surfaces(const SurfaceGrid& surfaces) {
  const bool counts = !surfaces.fragments.empty();
  const auto alpha = [&](size_t i) {
    return counts ? float(surfaces.fragments[i]) * (1.0f / 255.0f) : surfaces.albedo[i].a;
  };
  const auto attribute = [&](const std::string& name, size_t channels) {
    VolumeEntry volume = entry(name, index_.grid.size, channels, "voxelize");
    if (counts && channels == 4) volume.alpha = counted;
    return volume;
  };
  write_sparse(attribute("albedo", 4), surfaces,
               [&](size_t i, float* channels) { store(glm::vec4(glm::vec3(surfaces.albedo[i]), alpha(i)), channels); });
  if (storage_ != Storage::unorm8) {
    const auto write_vectors = [&](const std::string& name, const std::vector<glm::vec3>& values) {
      write_sparse(attribute(name, 3), surfaces, [&](size_t i, float* channels) { store(values[i], channels); });
    };
    write_vectors("normal", surfaces.normal);
    write_vectors("centroid", surfaces.centroid);
    if (!surfaces.emission.empty()) write_vectors("emission", surfaces.emission);
    return;
  }
  VolumeEntry normal = attribute("normal", 4);
  normal.encoding = signed_bytes;
  write_sparse(normal, surfaces, [&](size_t i, float* channels) {
    store(glm::vec4(0.5f * surfaces.normal[i] + 0.5f, alpha(i)), channels);
  });
  write_sparse(attribute("emission", 4), surfaces, [&](size_t i, float* channels) {
    store(glm::vec4(surfaces.emission.empty() ? glm::vec3(0.0f) : surfaces.emission[i], alpha(i)), channels);
  });
  write_sparse(attribute("static_flag", 1), surfaces, [&](size_t i, float* channels) {
    *channels = surfaces.dynamic.empty() || surfaces.dynamic[i] == 0 ? 1.0f : 0.0f;
  });
}

void VolumeFolderWriter::write_visibility(const SurfaceGrid& surfaces, std::span<const float> visibility) {
  write_sparse(entry("visibility", index_.grid.size, 1, "shade"), surfaces,
               [&](size_t i, float* channels) { *channels = visibility[i]; });
}

void VolumeFolderWriter::write_radiance(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance,
                                        bool bounced) {
  const VolumeEntry volume = light_entry(radiance_name(bounced), index_.grid.size, bounced ? "bounce" : "shade");
  write_sparse(volume, surfaces, [&](size_t i, float* channels) {
    const float opacity = surfaces.albedo[i].a;
    store(glm::vec4(opacity * radiance[i], opacity), channels);
  });
}

template <class Texel>
void VolumeFolderWriter::write_levels(const BasicPyramid<Texel>& pyramid, bool bounced) {
  for (size_t face = 0; face < face_names.size(); ++face)
    for (size_t level = 0; level < pyramid.levels.size(); ++level) {
      const BrickVolume<Directional<Texel>>& texels = pyramid.levels[level];
      VolumeEntry volume =
          light_entry(aniso_name(face, level, bounced), texels.size(), bounced ? "mipmap after bounce" : "mipmap");
      volume.face = face_names[face];
      volume.level = int(level);
      write(volume, [&](size_t z, std::span<float> slice) {
        fill_slice(texels, int(z), slice, [&](const Directional<Texel>& texel) { return texel[face]; });
      });
    }
}

template void VolumeFolderWriter::write_levels(const Pyramid&, bool);
template void VolumeFolderWriter::write_levels(const Pyramid16&, bool);
template void VolumeFolderWriter::write_levels(const Pyramid8&, bool);

void VolumeFolderWriter::finish() {
  write_volume_index(folder_, index_);
  finished_ = true;
}

}  // namespace voxref
