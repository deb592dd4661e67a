#pragma once
#include <string>
#include <vector>

#include "pipeline.h"
#include "study/study.h"
#include "study/thesis_shape.h"

namespace voxref {

struct ThesisSizes {
  std::vector<int> resolutions;
  static constexpr int published_base = 256;  ///< for which reasons of differences are known
  int base = published_base;                  ///< voxels; rows are set over those of this resolution
  /// Of timed images, in place of 1280 and 1920: as many times more pixels, see timed_view.
  int width_720 = 640, width_1080 = 960;
  int quality_width = 480, quality_base = 512;  ///< of the base pictures, 1920 and 512 there: pixels, voxels
  int spp = 128;                                ///< of path-traced references
};

/// @throws Error where a pixel is not finite @param scene its name
Image finite_image(ConeTraceResult result, const std::string& scene);

/// The base test's settings (thesis 4.3): no traced shadows, one bounce.
Settings thesis_settings(int resolution);
/// The shadow tests' (4.7, 4.8): the same without bounce; the voxels' and the pixels' shadows are to be chosen.
Settings thesis_shadow_settings(int resolution);

/// The view with as many pixels as a 16:9 one of this width, whatever the camera's aspect.
View timed_view(View view, int width);

// Seconds are the processor's, all threads together, so that they do not depend on what else the machine does.

/// One scene voxelized: the stages that follow share it.
class PreparedScene {
 public:
  /// Keeps references.
  PreparedScene(const StudyScene& scene, const Settings& settings, const Progress& progress);

  LitVoxels lit(const Settings& settings) const;
  /// Seconds of shading the voxels.
  Timing shading_timing(const Settings& settings) const;
  /// @throws Error where a pixel is not finite
  Image image(const Settings& settings, const LitVoxels& volume, int width) const;
  /// Seconds of a timed_view's pixels: less what an image two pixels wide takes, which is the G-buffer's own
  /// acceleration structure (a GPU rasterizes).
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
  Timing dynamic, shade, mipmap, bounce, bounce_mipmap;
  Timing cones;                  ///< of so many pixels as 1280x720 has, as measured on those of a timed_view
  Timing total;                  ///< of all but the static voxels
  size_t bytes = 0, voxels = 0;  ///< of all volumes; that surfaces occupy
};
StageTimings measure_stages(const StudyScene& scene, int resolution, int width, const Progress& progress);

}  // namespace voxref
