#include "stages.h"

#include "error.h"
#include "voxel/volume_writer.h"

namespace voxref {

namespace {

template <class Texel>
void mipmap_stage(const VolumeFolder& from, const Settings& settings, const std::filesystem::path& to,
                  const Progress& progress) {
  VolumeFolderWriter writer(to, from.grid(), settings.storage);
  bool found = false;
  for (const bool bounced : {false, true}) {
    if (!from.has(radiance_name(bounced))) continue;
    found = true;
    writer.write_levels(mipmap(from.grid(), from.base<Texel>(bounced), settings.mipmap, progress), bounced);
  }
  if (!found) throw Error(from.folder().string(), "volumes.json", "has neither radiance nor radiance_bounce to filter");
  writer.finish();
}

template <class Texel>
Clamping bounce_stage(const VolumeFolder& from, const Settings& settings, const glm::vec3& background,
                      const std::filesystem::path& to, const Progress& progress) {
  const SurfaceGrid surfaces = from.surfaces();
  const auto direct = from.radiance(surfaces, false);
  // What the stage before made of it, where it is there: an error in it shall not be taken for one of this stage.
  const bool filtered = from.has(aniso_name(0, 0, false));
  BasicPyramid<Texel> pyramid =
      filtered ? from.pyramid<Texel>(false) : mipmap<Texel>(surfaces, direct, settings.mipmap);
  const BasicBounceResult<Texel> result = bounce(surfaces, direct, std::move(pyramid), settings.bounce,
                                                 settings.render.cone, settings.mipmap, background, progress);
  VolumeFolderWriter writer(to, surfaces.grid, settings.storage);
  writer.write_radiance(surfaces, result.radiance, true);
  writer.write_levels(result.pyramid, true);
  writer.finish();
  return result.clamped;
}

}  // namespace

void run_voxelize(const Scene& scene, const Grid& grid, const Settings& settings, const std::filesystem::path& to,
                  const Progress& progress) {
  VolumeFolderWriter writer(to, grid, settings.storage);
  const Grid boxed = with_box_center(grid, scene.bounds(), settings.grid);
  writer.write_surfaces(voxelize(scene, boxed, settings.voxelize, progress));
  writer.finish();
}

Clamping run_shade(const VolumeFolder& from, const Scene& scene, const Settings& settings,
                   const std::filesystem::path& to, const Progress& progress) {
  const Caster caster(scene);
  const SurfaceGrid surfaces = from.surfaces();
  Shading lit = shade(scene, &caster, surfaces, settings.light, settings.shade, progress);
  Clamping clamped;
  with_texel(settings.storage, [&]<class Texel>(std::type_identity<Texel>) {
    for (glm::vec3& radiance : lit.radiance) radiance = clamped.store<Texel>(radiance);
  });
  VolumeFolderWriter writer(to, surfaces.grid, settings.storage);
  writer.write_visibility(surfaces, lit.visibility);
  writer.write_radiance(surfaces, lit.radiance, false);
  writer.finish();
  return clamped;
}

void run_mipmap(const VolumeFolder& from, const Settings& settings, const std::filesystem::path& to,
                const Progress& progress) {
  with_texel(settings.storage,
             [&]<class Texel>(std::type_identity<Texel>) { mipmap_stage<Texel>(from, settings, to, progress); });
}

Clamping run_bounce(const VolumeFolder& from, const Settings& settings, const glm::vec3& background,
                    const std::filesystem::path& to, const Progress& progress) {
  return with_texel(settings.storage, [&]<class Texel>(std::type_identity<Texel>) {
    return bounce_stage<Texel>(from, settings, background, to, progress);
  });
}

}  // namespace voxref
