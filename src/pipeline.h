#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "cone/render.h"
#include "settings.h"

namespace voxref {

/// Seconds of each stage, in the order of the pipeline.
struct StageSeconds {
  double voxelize = 0, shade = 0, mipmap = 0, bounce = 0, cone_trace = 0, total = 0;
};

struct ConeTraceResult {
  ConeImage image;
  glm::vec3 mean{0.0f};  ///< of R,G,B over the image
  Grid grid;
  size_t voxels_occupied = 0;
  int bounces = 0;
  double gain = 0.0;
  Clamping clamped_shade, clamped_bounce;  ///< radiance that `storage` could not hold: direct, and after the bounces
  StageSeconds seconds;
  std::map<std::string, size_t>
      bytes;  ///< per volume: surfaces, radiance, visibility, base, levels; `total` is the most held at once
};

struct ConeTraceOutputs {
  std::optional<std::filesystem::path> volumes;  ///< folder for every volume
};

/// The whole CPU port: voxelize, shade, mipmap, bounce, gather (spec.md), with the time and memory of each.
ConeTraceResult cone_trace(const Scene& scene, const Caster& caster, const View& view, const Settings& settings,
                           const ConeTraceOutputs& outputs = {}, const Progress& progress = {});

}  // namespace voxref
