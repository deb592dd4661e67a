#include "voxel/volume_file.h"

#include <algorithm>
#include <cmath>

#include "error.h"

namespace voxref {

namespace {

glm::ivec3 size_of(const VolumeEntry& entry) { return {int(entry.shape[2]), int(entry.shape[1]), int(entry.shape[0])}; }

bool empty(std::span<const float> texel) {
  return std::ranges::all_of(texel, [](float v) { return v == 0.0f; });
}
glm::vec3 rgb(std::span<const float> texel) { return {texel[0], texel[1], texel[2]}; }

/// Reads slice z, whose values must be finite: what NaN does further on would hide where it came from.
void read_finite(ArrayFile& volume, size_t z, std::span<float> slice) {
  volume.read_slice(z, slice);
  const auto bad = std::ranges::find_if_not(slice, [](float v) { return std::isfinite(v); });
  if (bad != slice.end()) throw Error(volume.name(), volume.place_of(z, size_t(bad - slice.begin())), "is not finite");
}

/// Calls visit(voxel, texel) for all texels of a volume, a slice in memory at a time.
template <class Visit>
void for_each_texel(ArrayFile& reader, const VolumeEntry& entry, Visit&& visit) {
  std::vector<float> slice(reader.slice_size());
  const size_t channels = entry.shape[3];
  const glm::ivec3 size = size_of(entry);
  for (int z = 0; z < size.z; ++z) {
    read_finite(reader, size_t(z), slice);
    const float* texel = slice.data();
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, texel += channels) visit(glm::ivec3(x, y, z), std::span(texel, channels));
  }
}

/// The voxel's place in the file, for messages.
std::string place_of(const glm::ivec3& v) {
  return "[" + std::to_string(v.z) + "," + std::to_string(v.y) + "," + std::to_string(v.x) + "]";
}

void require_opacity(float alpha, const std::string& file, const glm::ivec3& voxel) {
  if (!(alpha >= 0.0f && alpha <= 1.0f)) throw Error(file, place_of(voxel), "opacity is outside 0 to 1");
}

glm::vec4 premultiplied(const VolumeEntry& entry, std::span<const float> texel) {
  return glm::vec4((entry.premultiplied ? 1.0f : texel[3]) * rgb(texel), texel[3]);
}

}  // namespace

ArrayFile open_volume(const std::filesystem::path& folder, const VolumeEntry& entry) {
  ArrayFile volume(folder / entry.file, entry.mip, ArrayMeaning::volume);
  if (volume.shape() != entry.shape) throw Error(volume.name(), "header", "shape is not the one in volumes.json");
  if (volume.type() != entry.type) throw Error(volume.name(), "header", "type is not the one in volumes.json");
  return volume;
}

VolumeFolder::VolumeFolder(std::filesystem::path folder)
    : folder_(std::move(folder)), index_(read_volume_index(folder_)) {}

const VolumeEntry& VolumeFolder::entry(const std::string& name) const {
  const VolumeEntry* found = index_.find(name);
  if (!found) throw Error(index_file(folder_).string(), "volumes", "has no volume '" + name + "'");
  return *found;
}

std::string VolumeFolder::file(const VolumeEntry& entry) const { return (folder_ / entry.file).string(); }

ArrayFile VolumeFolder::open(const VolumeEntry& entry, const glm::ivec3& size, size_t least_channels) const {
  if (size_of(entry) != size || entry.shape[3] < least_channels)
    throw Error(index_file(folder_).string(), entry.name, "has a shape that does not fit the grid and its level");
  return open_volume(folder_, entry);
}

void VolumeFolder::read_sparse(const VolumeEntry& entry, const SurfaceGrid& surfaces, size_t least_channels,
                               const std::function<void(size_t, std::span<const float>)>& get) const {
  ArrayFile reader = open(entry, surfaces.grid.size, least_channels);
  std::vector<float> slice(reader.slice_size());
  for (size_t i = 0, z = size_t(-1); i < surfaces.size(); ++i) {
    const glm::ivec3& v = surfaces.voxels[i];
    if (size_t(v.z) != z) read_finite(reader, z = size_t(v.z), slice);
    const size_t channels = entry.shape[3], texel = size_t(v.x) + entry.shape[2] * size_t(v.y);
    get(i, std::span(slice).subspan(texel * channels, channels));
  }
}

SurfaceGrid VolumeFolder::surfaces() const {
  SurfaceGrid surfaces;
  surfaces.grid = grid();
  const VolumeEntry& albedo = entry("albedo");
  const bool counts = albedo.alpha.starts_with("count");
  ArrayFile reader = open(albedo, grid().size, 4);
  for_each_texel(reader, albedo, [&](const glm::ivec3& voxel, std::span<const float> texel) {
    require_opacity(texel[3], file(albedo), voxel);
    if (texel[3] == 0.0f) return;
    surfaces.voxels.push_back(voxel);
    surfaces.albedo.emplace_back(rgb(texel), counts ? 1.0f : texel[3]);
    if (counts) surfaces.fragments.push_back(uint8_t(std::lround(255.0f * texel[3])));
  });

  const VolumeEntry& normal = entry("normal");
  if (!normal.encoding.empty() && normal.encoding != signed_bytes)
    throw Error(index_file(folder_).string(), "normal", "has an unknown encoding '" + normal.encoding + "'");
  surfaces.normal.resize(surfaces.size());
  read_sparse(normal, surfaces, 3, [&](size_t i, std::span<const float> texel) {
    surfaces.normal[i] = normal.encoding.empty() ? rgb(texel) : 2.0f * rgb(texel) - 1.0f;
  });

  surfaces.centroid.resize(surfaces.size());
  for (size_t i = 0; i < surfaces.size(); ++i) surfaces.centroid[i] = grid().center(surfaces.voxels[i]);
  if (has("centroid"))
    read_sparse(entry("centroid"), surfaces, 3,
                [&](size_t i, std::span<const float> texel) { surfaces.centroid[i] = rgb(texel); });
  if (has("emission")) {
    surfaces.emission.resize(surfaces.size());
    read_sparse(entry("emission"), surfaces, 3,
                [&](size_t i, std::span<const float> texel) { surfaces.emission[i] = rgb(texel); });
    const auto dark = [](const glm::vec3& emission) { return emission == glm::vec3(0.0f); };
    if (std::ranges::all_of(surfaces.emission, dark)) surfaces.emission = std::vector<glm::vec3>();
  }
  return surfaces;
}

std::vector<glm::vec3> VolumeFolder::radiance(const SurfaceGrid& surfaces, bool bounced) const {
  const VolumeEntry& volume = entry(radiance_name(bounced));
  std::vector<glm::vec3> radiance(surfaces.size());
  read_sparse(volume, surfaces, 4, [&](size_t i, std::span<const float> texel) {
    const bool divide = volume.premultiplied && texel[3] > 0.0f;
    radiance[i] = divide ? rgb(texel) / texel[3] : rgb(texel);
  });
  return radiance;
}

std::vector<float> VolumeFolder::visibility(const SurfaceGrid& surfaces) const {
  std::vector<float> visibility(surfaces.size());
  read_sparse(entry("visibility"), surfaces, 1,
              [&](size_t i, std::span<const float> texel) { visibility[i] = texel[0]; });
  return visibility;
}

template <class Texel>
BrickVolume<Texel> VolumeFolder::base(bool bounced) const {
  const VolumeEntry& volume = entry(radiance_name(bounced));
  BrickVolume<Texel> base(grid().size);
  BrickSet bricks(base.brick_grid());
  ArrayFile reader = open(volume, base.size(), 4);
  for_each_texel(reader, volume, [&](const glm::ivec3& voxel, std::span<const float> texel) {
    require_opacity(texel[3], file(volume), voxel);
    if (!empty(texel)) bricks.add(voxel / base.side);
  });
  base.allocate(bricks.sorted());
  for_each_texel(reader, volume, [&](const glm::ivec3& voxel, std::span<const float> texel) {
    if (!empty(texel)) base(voxel) = encode<Texel>(load(premultiplied(volume, texel)));
  });
  return base;
}

template <class Texel>
BrickVolume<Directional<Texel>> VolumeFolder::level(size_t level, const glm::ivec3& size, bool bounced) const {
  BrickVolume<Directional<Texel>> texels(size);
  BrickSet bricks(texels.brick_grid());
  const auto visit_faces = [&](auto&& visit) {
    for (size_t face = 0; face < face_names.size(); ++face) {
      const VolumeEntry& volume = entry(aniso_name(face, level, bounced));
      ArrayFile reader = open(volume, size, 4);
      for_each_texel(reader, volume, [&](const glm::ivec3& voxel, std::span<const float> texel) {
        require_opacity(texel[3], file(volume), voxel);
        if (!empty(texel)) visit(face, voxel, premultiplied(volume, texel));
      });
    }
  };
  visit_faces([&](size_t, const glm::ivec3& voxel, const glm::vec4&) { bricks.add(voxel / texels.side); });
  texels.allocate(bricks.sorted());
  visit_faces([&](size_t face, const glm::ivec3& voxel, const glm::vec4& value) {
    texels(voxel)[face] = encode<Texel>(load(value));
  });
  return texels;
}

template <class Texel>
BasicPyramid<Texel> VolumeFolder::pyramid(bool bounced) const {
  BasicPyramid<Texel> pyramid{grid(), base<Texel>(bounced), {}};
  for (glm::ivec3 size = grid().size; size != glm::ivec3(1);) {
    size = (size + 1) / 2;
    pyramid.levels.push_back(level<Texel>(pyramid.levels.size(), size, bounced));
  }
  return pyramid;
}

template BrickVolume<glm::vec4> VolumeFolder::base(bool) const;
template BrickVolume<Rgba16f> VolumeFolder::base(bool) const;
template BrickVolume<Rgba8> VolumeFolder::base(bool) const;
template Pyramid VolumeFolder::pyramid(bool) const;
template Pyramid16 VolumeFolder::pyramid(bool) const;
template Pyramid8 VolumeFolder::pyramid(bool) const;

}  // namespace voxref
