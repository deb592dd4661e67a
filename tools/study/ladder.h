#pragma once
#include <optional>
#include <string>
#include <vector>

#include "compare/statistics.h"
#include "settings.h"
#include "study/deviation.h"
#include "study/study.h"

namespace voxref {

/// An image as luminance, from independent tries; one alone: there is no noise.
struct RungImage {
  std::string name;  ///< what is different from the rung before
  std::vector<std::vector<double>> tries;
};

/// How far a rung is from another, over some pixels.
struct RungStep {
  Estimate bias;      ///< mean difference, radiance; its error from the tries, 0 where there is but one
  MeanSquare square;  ///< of the differences per pixel, noise removed
};
/// Pairs the tries, so that noise which both share cancels. @param pixels indices; at least one
RungStep rung_step(const RungImage& from, const RungImage& to, const std::vector<size_t>& pixels);

/// Part of the image.
struct Region {
  std::string name;
  std::vector<size_t> pixels;
};

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

struct LadderClimb {
  std::vector<RungImage> rungs;
  size_t shipped = 0;          ///< the rung of the shipped settings; those of other storages follow
  size_t first_published = 0;  ///< the first rung of published parameters, which start from bytes as storage
  std::vector<double> direct;  ///< direct light that paths found, luminance per pixel
};
/// The rungs from the path tracer to the shipped settings and on, each different from the one before in one thing. All
/// light (R,G,B) at the pixels' centres. @throws Interrupted
LadderClimb climb_ladder(const StudyScene& scene, const View& view, const LadderOptions& options,
                         const Progress& progress);

/// Whether the rungs up to the published ones, added up, are what separates their ends: both are rendered anew, the
/// path-traced one with another seed. A row per region; `p` is the probability of a gap at least as large by chance.
Table closure(const StudyScene& scene, const View& view, const LadderOptions& options, const LadderClimb& climb,
              const std::vector<Region>& regions, const Progress& progress);

Section ladder_section(const StudyScene& scene, const LadderOptions& options, const std::filesystem::path& gpu_image,
                       const Progress& progress);

}  // namespace voxref
