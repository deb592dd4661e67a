#pragma once
#include <chrono>
#include <vector>

#include "pipeline.h"
#include "study/study.h"

namespace voxref {

struct ThesisSizes {
  std::vector<int> resolutions;
  int base = 256;                                ///< voxels; rows are set over those of this resolution
  int width_720 = 1280, width_1080 = 1920;       ///< pixels, in place of the published screens
  int quality_width = 1920, quality_base = 512;  ///< of the base pictures: pixels, voxels
};

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The base test's settings (thesis 4.3): no traced shadows, one bounce.
Settings thesis_settings(int resolution);

/// One scene voxelized: the stages that follow share it.
class PreparedScene {
 public:
  /// Keeps references.
  PreparedScene(const StudyScene& scene, const Settings& settings, const Progress& progress);

  LitVoxels lit(const Settings& settings) const;
  Image image(const Settings& settings, const LitVoxels& volume, int width) const;
  /// Seconds of the image's pixels: less what an image of two pixels takes, which is that of the G-buffer's own
  /// acceleration structure (a GPU rasterizes).
  double image_seconds(const Settings& settings, const LitVoxels& volume, int width) const;

  double fixed = 0, dynamic = 0;  ///< seconds of both voxelizations

 private:
  const StudyScene& scene_;
  Caster caster_;
  SurfaceGrid surfaces_;
  const Progress& progress_;
};

// Sections of `study thesis`; times are in thesis.cpp.
Section thesis_quality(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress);
Section thesis_emission(const ThesisSizes& sizes, const Progress& progress);
Section thesis_memory_use(const std::vector<StudyScene>& scenes, const ThesisSizes& sizes, const Progress& progress);

}  // namespace voxref
