#include "volume_bytes.h"

#include <algorithm>

namespace voxref {
namespace {

/// Of a volume of which `bricks` are stored.
template <class Texel>
size_t volume_bytes(const glm::ivec3& size, size_t bricks) {
  using Volume = BrickVolume<Texel>;
  const glm::ivec3 table = (size + Volume::side - 1) / Volume::side;
  return bricks * Volume::texels_per_brick * sizeof(Texel) +
         size_t(table.x) * size_t(table.y) * size_t(table.z) * sizeof(uint32_t);
}

template <class Texel>
void add_texels(VolumeBytes& bytes, const SurfaceGrid& surfaces, bool extinction) {
  std::vector<glm::ivec3> bricks = occupied_bricks(surfaces);
  glm::ivec3 size = surfaces.grid.size;
  bytes["base"] = volume_bytes<Texel>(size, bricks.size());
  while (size != glm::ivec3(1)) {
    size = (size + 1) / 2;
    BrickSet coarser((size + BrickVolume<Texel>::side - 1) / BrickVolume<Texel>::side);
    for (const glm::ivec3& brick : bricks) coarser.add(brick / 2);
    bricks = coarser.sorted();
    bytes["levels"] += volume_bytes<Directional<Texel>>(size, bricks.size());
    if (extinction) bytes["depths"] += volume_bytes<glm::vec3>(size, bricks.size());
  }
}

}  // namespace

void add_total(VolumeBytes& bytes, const Settings& settings) {
  const size_t volumes = bytes["base"] + bytes["levels"], beside = bytes["occupancy"] + bytes["depths"];
  const size_t voxels = bytes["surfaces"] + bytes["radiance"] + bytes["visibility"];
  // Cones are traced at the voxels while their surfaces are there, at the pixels when they are gone.
  bytes["total"] =
      settings.bounce.count != 0 ? voxels + volumes + beside : std::max(voxels + volumes, volumes + beside);
}

VolumeBytes predict_bytes(const SurfaceGrid& surfaces, const Settings& settings) {
  VolumeBytes bytes;
  bytes["surfaces"] = surfaces.bytes();
  bytes["radiance"] = (settings.bounce.count != 0 ? 2 : 1) * surfaces.size() * sizeof(glm::vec3);
  bytes["visibility"] = surfaces.size() * sizeof(float);
  const bool extinction = settings.render.cone.opacity == ConeOpacity::extinction;
  const bool joined = extinction && settings.mipmap.filter == MipmapFilter::anisotropic;
  with_texel(settings.storage,
             [&]<class Texel>(std::type_identity<Texel>) { add_texels<Texel>(bytes, surfaces, joined); });
  bytes["occupancy"] = Occupancy(surfaces).bytes();
  add_total(bytes, settings);
  return bytes;
}

}  // namespace voxref
