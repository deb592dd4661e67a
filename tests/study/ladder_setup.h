#pragma once
#include <algorithm>
#include <numeric>

#include "pipeline.h"
#include "study/ladder.h"

namespace voxref {

/// Small, and quick.
inline LadderOptions small_options(int resolution) {
  LadderOptions options;
  options.resolution = resolution;
  options.tries = 4;
  options.spp = 32;
  options.marched_rays = 8;
  options.voxel_rays = 4;
  options.narrow_cones = 64;
  return options;
}

inline std::vector<size_t> all_pixels(const LadderClimb& climb) {
  std::vector<size_t> pixels(climb.rungs[0].tries[0].size());
  std::iota(pixels.begin(), pixels.end(), size_t{0});
  return pixels;
}

inline size_t rung_named(const LadderClimb& climb, const std::string& name) {
  const auto found = std::find_if(climb.rungs.begin(), climb.rungs.end(),
                                  [&](const RungImage& rung) { return rung.name.find(name) != rung.name.npos; });
  return static_cast<size_t>(found - climb.rungs.begin());
}

inline std::vector<double> cone_traced(const StudyScene& scene, const View& view, const Settings& settings) {
  const Caster caster(scene.scene);
  return measured_cone(cone_trace(scene.scene, caster, view, settings).image.image, false).value;
}

}  // namespace voxref
