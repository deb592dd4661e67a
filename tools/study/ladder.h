#pragma once
#include <optional>
#include <string>
#include <vector>

#include "settings.h"
#include "study/study.h"

namespace voxref {

/// An image as luminance, from independent tries; one alone: there is no noise.
struct RungImage {
  std::string name;  ///< what is different from the rung before
  std::vector<std::vector<double>> tries;
};

/// How far a rung is from another, over some pixels.
struct RungStep {
  double bias = 0, bias_error = 0;  ///< mean difference, and its standard error from the tries
  double rms = 0, rms_error = 0;    ///< RMS difference per pixel, noise removed, and its standard error
};
/// Pairs the tries, so that noise which both share cancels. @param pixels indices; at least one
RungStep rung_step(const RungImage& from, const RungImage& to, const std::vector<size_t>& pixels);

struct LadderOptions {
  int resolution = 128;   ///< a power of two, for the published rungs
  int width = 128;        ///< pixels
  int tries = 8;          ///< independent images of the rungs that are noisy
  int spp = 64;           ///< paths, and rays, per pixel and try
  int marched_rays = 32;  ///< per pixel and try, through the finest voxels
  int voxel_rays = 64;    ///< per voxel and bounce
  int narrow_cones = 256;
  bool published = true;  ///< goes on to villegas2016, parameter by parameter
};

/// The rungs from the path tracer to the shipped settings, each different from the one before in one thing. All light
/// (R,G,B) at the pixels' centres. @param first_published set to the first rung of published parameters
std::vector<RungImage> climb_ladder(const StudyScene& scene, const View& view, const LadderOptions& options,
                                    size_t& first_published, const Progress& progress);

Section ladder_section(const StudyScene& scene, const LadderOptions& options, const std::filesystem::path& gpu_image,
                       const Progress& progress);

}  // namespace voxref
