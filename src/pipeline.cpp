#include "pipeline.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "voxel/volume_writer.h"

namespace voxref {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Runs a stage and adds the time that it took to `seconds`.
template <class Stage>
auto timed(double& seconds, const Stage& stage) {
  const auto start = std::chrono::steady_clock::now();
  auto result = stage();
  seconds += seconds_since(start);
  return result;
}

glm::vec3 mean_color(const Image& image) {
  const auto color = image.layer("");
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < image.pixel_count(); ++i) sum += glm::dvec3(color[0][i], color[1][i], color[2][i]);
  return glm::vec3(sum / double(image.pixel_count()));
}

/// Gives back what a stage freed: of pages that held many small blocks glibc's heap keeps all but the last ones, which
/// is a twentieth of Sponza's peak at 512 voxels.
void give_back_freed_memory() { malloc_trim(0); }

/// What cones march through. @param depth_bytes those that the bounces held
void count_bytes(VolumeBytes& bytes, const LitVolume& volume, size_t depth_bytes) {
  std::visit(
      [&](const auto& v) {
        if constexpr (requires { v.depth_bytes; }) depth_bytes = std::max(depth_bytes, v.depth_bytes);
        bytes["base"] = v.texels.base.bytes();
        for (const auto& level : v.texels.levels) bytes["levels"] += level.bytes();
        bytes["occupancy"] = v.occupied.bytes();
      },
      volume);
  if (depth_bytes != 0) bytes["depths"] = depth_bytes;
}

/// The stages between voxelization and image, with volumes of one storage.
template <class Texel>
LitVoxels light(const Scene& scene, const Caster& caster, SurfaceGrid surfaces, const glm::vec3& background,
                const Settings& settings, VolumeFolderWriter* folder, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  LitVoxels result;
  StageSeconds& seconds = result.seconds;
  result.grid = surfaces.grid;
  result.voxels_occupied = surfaces.size();
  Shading shading = timed(seconds.shade, [&] {
    Shading lit = shade(scene, &caster, surfaces, settings.light, settings.shade, progress);
    result.nonfinite.add(surfaces, lit.radiance);
    for (glm::vec3& radiance : lit.radiance) radiance = result.clamped_shade.store<Texel>(radiance);
    return lit;
  });
  BasicPyramid<Texel> pyramid =
      timed(seconds.mipmap, [&] { return mipmap<Texel>(surfaces, shading.radiance, settings.mipmap, progress); });
  if (folder) {
    folder->write_surfaces(surfaces);
    folder->write_visibility(surfaces, shading.visibility);
    folder->write_radiance(surfaces, shading.radiance, false);
    folder->write_levels(pyramid, false);
  }

  VolumeBytes& bytes = result.bytes;
  bytes["surfaces"] = surfaces.bytes();
  bytes["radiance"] = shading.radiance.capacity() * sizeof(glm::vec3);
  bytes["visibility"] = shading.visibility.capacity() * sizeof(float);
  if (shading.shadow_bytes != 0) bytes["shadow"] = shading.shadow_bytes;
  const bool lights_seen = settings.render.pixel.shadow == PixelShadow::visibility;
  if (!lights_seen) shading.visibility = std::vector<float>();  // {} would keep the memory

  size_t depth_bytes = 0;
  if (settings.bounce.count != 0) {
    BasicBounceResult<Texel> bounced = timed(seconds.bounce, [&] {
      return bounce(surfaces, shading.radiance, std::move(pyramid), settings.bounce, settings.render.cone,
                    settings.mipmap, background, progress);
    });
    result.bounces = bounced.bounces;
    result.gain = bounced.gain;
    result.clamped_bounce = bounced.clamped;
    bytes["radiance"] += bounced.radiance.capacity() * sizeof(glm::vec3);
    depth_bytes = bounced.depth_bytes;
    pyramid = std::move(bounced.pyramid);
    if (folder) {
      folder->write_radiance(surfaces, bounced.radiance, true);
      folder->write_levels(pyramid, true);
    }
  }
  if (lights_seen) {
    if constexpr (std::is_same_v<Texel, Rgba8>)  // as the volume holds it, which is of float32 otherwise
      for (float& share : shading.visibility) share = decode_alpha(encode<Texel>(Float4{0.0f, 0.0f, 0.0f, share}));
    result.visibility.emplace(surfaces, shading.visibility);
    bytes["light_visibility"] = result.visibility->bytes();
  }
  surfaces = {};  // the image needs none of them
  shading = {};
  result.volume = timed(seconds.prepare, [&] {
    return lit_volume(std::move(pyramid), settings.render.cone.opacity, settings.mipmap.filter);
  });
  count_bytes(bytes, result.volume, depth_bytes);
  add_total(bytes, settings);
  seconds.total = seconds_since(start);
  return result;
}

}  // namespace

void NonfiniteVoxels::add(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance) {
  for (size_t i = 0; i < radiance.size(); ++i) {
    const glm::vec3& value = radiance[i];
    if (std::isfinite(value.r) && std::isfinite(value.g) && std::isfinite(value.b)) continue;
    if (count++ == 0) first = surfaces.voxels[i];
  }
}

LitVoxels light_voxels(const Scene& scene, const Caster& caster, SurfaceGrid surfaces, const glm::vec3& background,
                       const Settings& settings, VolumeFolderWriter* folder, const Progress& progress) {
  return with_texel(settings.storage, [&]<class Texel>(std::type_identity<Texel>) {
    return light<Texel>(scene, caster, std::move(surfaces), background, settings, folder, progress);
  });
}

ConeTraceResult gather_image(const Scene& scene, const Caster& caster, const View& view, const Settings& settings,
                             const LitVoxels& lit, const Progress& progress) {
  ConeTraceResult result;
  result.grid = lit.grid;
  result.voxels_occupied = lit.voxels_occupied;
  result.bounces = lit.bounces;
  result.gain = lit.gain;
  result.bytes = lit.bytes;
  result.nonfinite_voxels = lit.nonfinite;
  result.clamped_shade = lit.clamped_shade;
  result.clamped_bounce = lit.clamped_bounce;
  result.seconds = lit.seconds;
  result.image = timed(result.seconds.cone_trace, [&] {
    const LitScene from{scene,          caster,
                        lit.volume,     settings.grid.bounds.value_or(scene.bounds()),
                        settings.light, lit.visibility ? &*lit.visibility : nullptr};
    return render_cones(from, view, settings.render, progress);
  });
  result.seconds.total += result.seconds.cone_trace;
  result.mean = mean_color(result.image.image);
  return result;
}

ConeTraceResult cone_trace(const Scene& scene, const Caster& caster, const View& view, const Settings& settings,
                           const ConeTraceOutputs& outputs, const Progress& progress) {
  validate(settings);
  const auto start = std::chrono::steady_clock::now();
  const Grid grid = fit_grid(scene.bounds(), settings.grid);
  std::optional<VolumeFolderWriter> folder;
  if (outputs.volumes) folder.emplace(*outputs.volumes, grid, settings.storage);
  double voxelizing = 0.0;
  SurfaceGrid surfaces = timed(voxelizing, [&] { return voxelize(scene, grid, settings.voxelize, progress); });
  give_back_freed_memory();
  const LitVoxels lit = light_voxels(scene, caster, std::move(surfaces), view.background, settings,
                                     folder ? &*folder : nullptr, progress);
  ConeTraceResult result = gather_image(scene, caster, view, settings, lit, progress);
  if (folder) folder->finish();  // not before: a run that fails or is stopped leaves no volumes
  result.seconds.voxelize = voxelizing;
  result.seconds.total = seconds_since(start);
  return result;
}

}  // namespace voxref
