#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "cone/render.h"
#include "settings.h"
#include "volume_bytes.h"

namespace voxref {

class VolumeFolderWriter;

/// Seconds of each stage, in the order of the pipeline.
struct StageSeconds {
  double voxelize = 0, shade = 0, mipmap = 0, bounce = 0;
  double prepare = 0;     ///< making the volume ready for marching; grows with the voxels, not with the image
  double cone_trace = 0;  ///< the image
  double total = 0;
};

/// Voxels whose direct light came out as a NaN or an infinity, before any storage: what it stores of them is no light.
struct NonfiniteVoxels {
  size_t count = 0;
  glm::ivec3 first{0};  ///< of them, by z, y, x

  void add(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance);
};

/// Of the cone tracer's image: 23 float32 channels.
constexpr size_t cone_image_bytes_per_pixel = 23 * sizeof(float);

struct ConeTraceResult {
  ConeImage image;
  glm::vec3 mean{0.0f};  ///< of R,G,B over the image
  Grid grid;
  size_t voxels_occupied = 0;
  int bounces = 0;
  double gain = 0.0;
  NonfiniteVoxels nonfinite_voxels;
  Clamping clamped_shade, clamped_bounce;  ///< radiance that `storage` could not hold: direct, and after the bounces
  StageSeconds seconds;
  VolumeBytes bytes;  ///< that were allocated
};

/// What images are gathered from: the voxels after light was brought to them, filtered and bounced.
struct LitVoxels {
  Grid grid;
  size_t voxels_occupied = 0;
  LitVolume volume;
  std::optional<LightVisibility> visibility;  ///< where pixel.shadow asks for it
  int bounces = 0;
  double gain = 0.0;
  NonfiniteVoxels nonfinite;
  Clamping clamped_shade, clamped_bounce;  ///< as ConeTraceResult's
  StageSeconds seconds;                    ///< total: of all of it
  VolumeBytes bytes;                       ///< as ConeTraceResult's
};

struct ConeTraceOutputs {
  std::optional<std::filesystem::path> volumes;  ///< folder for every volume
};

/// The whole CPU port: voxelize, shade, mipmap, bounce, gather (spec.md), with the time and memory of each.
ConeTraceResult cone_trace(const Scene& scene, const Caster& caster, const View& view, const Settings& settings,
                           const ConeTraceOutputs& outputs = {}, const Progress& progress = {});

/// Its stages apart, for settings that share some: all that is done to voxelized surfaces (moved in: they are freed
/// when no longer needed) ...
LitVoxels light_voxels(const Scene& scene, const Caster& caster, SurfaceGrid surfaces, const glm::vec3& background,
                       const Settings& settings, VolumeFolderWriter* folder = nullptr, const Progress& progress = {});
/// ... and the image; `seconds` and `bytes` are those of all stages but voxelization, which made no part of `lit`.
ConeTraceResult gather_image(const Scene& scene, const Caster& caster, const View& view, const Settings& settings,
                             const LitVoxels& lit, const Progress& progress = {});

}  // namespace voxref
