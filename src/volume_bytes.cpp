#include "volume_bytes.h"

#include <algorithm>

#include "voxel/shadow_volume.h"

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
void add_texels(VolumeBytes& bytes, const SurfaceGrid& surfaces, bool depths) {
  std::vector<glm::ivec3> bricks = occupied_bricks(surfaces);
  glm::ivec3 size = surfaces.grid.size;
  bytes["base"] = volume_bytes<Texel>(size, bricks.size());
  while (size != glm::ivec3(1)) {
    size = (size + 1) / 2;
    BrickSet coarser((size + BrickVolume<Texel>::side - 1) / BrickVolume<Texel>::side);
    for (const glm::ivec3& brick : bricks) coarser.add(brick / 2);
    bricks = coarser.sorted();
    bytes["levels"] += volume_bytes<Directional<Texel>>(size, bricks.size());
    if (depths) bytes["depths"] += volume_bytes<glm::vec3>(size, bricks.size());
  }
}

/// Bytes of a volume, 0 where there is none such.
size_t of(const VolumeBytes& bytes, const char* volume) {
  const auto found = bytes.find(volume);
  return found == bytes.end() ? 0 : found->second;
}

/// Whether depths are held while the voxels' light is made ready for cones, those of bounces or of pixels.
bool depths_for_bounces(const Settings& settings) {
  return settings.bounce.count != 0 && settings.bounce.cones != published_cones &&
         settings.mipmap.filter == MipmapFilter::anisotropic;
}
bool depths_for_pixels(const Settings& settings) {
  return settings.render.cone.opacity == ConeOpacity::extinction && settings.mipmap.filter == MipmapFilter::anisotropic;
}

}  // namespace

void add_total(VolumeBytes& bytes, const Settings& settings) {
  const bool bounces = settings.bounce.count != 0;
  const size_t surfaces = of(bytes, "surfaces"), radiance = of(bytes, "radiance");
  const size_t lit = surfaces + of(bytes, "visibility") + (bounces ? radiance / 2 : radiance);
  const size_t volumes = of(bytes, "base") + of(bytes, "levels");
  const size_t marched = volumes + of(bytes, "occupancy"), depths = of(bytes, "depths");
  const size_t visibility = of(bytes, "light_visibility");

  const size_t shade = lit + of(bytes, "shadow"), filtered = lit + volumes + visibility;
  const size_t kept = settings.render.pixel.shadow == PixelShadow::visibility ? of(bytes, "visibility") : 0;
  const size_t bounce =
      bounces ? surfaces + kept + radiance + marched + (depths_for_bounces(settings) ? depths : 0) : 0;
  const size_t image = marched + visibility + (depths_for_pixels(settings) ? depths : 0);  // the surfaces are gone
  bytes["total"] = std::max({shade, filtered, bounce, image});
}

VolumeBytes predict_bytes(const SurfaceGrid& surfaces, const Settings& settings) {
  VolumeBytes bytes;
  bytes["surfaces"] = surfaces.bytes();
  bytes["radiance"] = (settings.bounce.count != 0 ? 2 : 1) * surfaces.size() * sizeof(glm::vec3);
  bytes["visibility"] = surfaces.size() * sizeof(float);
  with_texel(settings.storage, [&]<class Texel>(std::type_identity<Texel>) {
    add_texels<Texel>(bytes, surfaces, depths_for_bounces(settings) || depths_for_pixels(settings));
  });
  bytes["occupancy"] = Occupancy(surfaces).bytes();
  const glm::ivec3& size = surfaces.grid.size;
  if (settings.shade.shadow == VoxelShadow::volume)  // occupancy of one level would do: 0.4 % less
    bytes["shadow"] = settings.shade.shadow_hit
                          ? ShadowVolume(surfaces).bytes()
                          : volume_bytes<glm::vec4>(size, occupied_bricks(surfaces).size()) + bytes["occupancy"];
  if (settings.render.pixel.shadow == PixelShadow::visibility)
    bytes["light_visibility"] = volume_bytes<float>(size, occupied_bricks(surfaces).size());
  add_total(bytes, settings);
  return bytes;
}

}  // namespace voxref
