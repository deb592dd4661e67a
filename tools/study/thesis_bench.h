#pragma once
#include <cstdint>
#include <vector>

#include "pipeline.h"
#include "study/study.h"
#include "study/thesis_shape.h"

namespace voxref {

struct ThesisSizes {
  std::vector<int> resolutions;
  int base = 256;                               ///< voxels; rows are set over those of this resolution
  int width_720 = 640, width_1080 = 960;        ///< pixels, in place of 1280 and 1920: as many times more pixels
  int quality_width = 480, quality_base = 512;  ///< of the base pictures, 1920 and 512 there: pixels, voxels
  int spp = 128;                                ///< of path-traced references
};

/// The base test's settings (thesis 4.3): no traced shadows, one bounce.
Settings thesis_settings(int resolution);
/// The shadow tests' (4.7, 4.8): the same without bounce; the voxels' and the pixels' shadows are to be chosen.
Settings thesis_shadow_settings(int resolution);

// Seconds are the processor's, all threads together, so that they do not depend on what else the machine does.

/// One scene voxelized: the stages that follow share it.
class PreparedScene {
 public:
  /// Keeps references.
  PreparedScene(const StudyScene& scene, const Settings& settings, const Progress& progress);

  LitVoxels lit(const Settings& settings) const;
  /// Seconds of shading the voxels.
  Timing shading_timing(const Settings& settings) const;
  Image image(const Settings& settings, const LitVoxels& volume, int width) const;
  /// Seconds of an image's pixels: less what an image two pixels wide takes, which is the G-buffer's own acceleration
  /// structure (a GPU rasterizes).
  Timing image_timing(const Settings& settings, const LitVoxels& volume, int width) const;

 private:
  const StudyScene& scene_;
  Caster caster_;
  SurfaceGrid surfaces_;
  const Progress& progress_;
};

/// The columns of tables 4.3 and 4.4.
struct StageTimings {
  Timing fixed;
  Timing clear;  ///< taking the static voxels over, without what was dynamic
  Timing dynamic, shade, mipmap, bounce, bounce_mipmap, cones;
  Timing total;  ///< of all but the static voxels
  size_t bytes = 0;
};
StageTimings measure_stages(const StudyScene& scene, int resolution, int width, const Progress& progress);

/// What a scene's volumes take with the base test's settings, bytes.
size_t volume_memory(const StudyScene& scene, int resolution, const Progress& progress);

}  // namespace voxref
