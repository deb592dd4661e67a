#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "progress.h"
#include "scene/camera.h"
#include "scene/caster.h"
#include "settings.h"
#include "terminal.h"

namespace voxref {

/// One stage of the cone tracer, measured several times.
struct StageBench {
  std::string stage;
  std::string unit;             ///< of what is counted: voxels, texels, cones
  double count = 0;             ///< of them, per round
  double bytes = 0;             ///< read and written at least once, per round: what the stage takes and what it makes
  std::vector<double> seconds;  ///< one per round
};

/// Voxelize, shade, mipmap, one bounce, making the volume ready, and the image, each as often as asked. Times are the
/// clock's on the wall, or the processor's (all threads together). @throws Error for a scene that occupies no voxel
std::vector<StageBench> bench_stages(const Scene& scene, const Caster& caster, const View& view,
                                     const Settings& settings, int rounds, bool processor_time,
                                     const Progress& progress);

/// Bytes per second that a[i] = b[i] + s c[i] moves over arrays beyond the caches, with all threads: the best of
/// several runs (McCalpin's STREAM triad; what a write reads before it is not counted).
double triad_bandwidth();

// Medians, one line or object per stage, beside the bandwidth of the triad,
void say(Terminal& terminal, const std::vector<StageBench>& stages, double bandwidth);
nlohmann::json to_json(const std::vector<StageBench>& stages, double bandwidth);
// and beside what the published shaders took for the same scene, at 256 voxels and 256x256 pixels.
void say_published(Terminal& terminal, const std::vector<StageBench>& stages);
nlohmann::json published_to_json(const std::vector<StageBench>& stages);

}  // namespace voxref
