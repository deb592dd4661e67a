#pragma once
#include <optional>
#include <string>
#include <vector>

#include "compare/statistics.h"
#include "image/image.h"
#include "settings.h"
#include "study/deviation.h"
#include "study/study.h"

namespace voxref {

/// An image as luminance, from independent tries; one alone: there is no noise.
struct RungImage {
  std::string name;  ///< what is different from the rung before
  std::vector<std::vector<double>> tries;
};

/// Mean over pixels and tries, radiance.
double mean(const RungImage& image);

/// How far a rung is from another, over some pixels.
struct RungStep {
  Estimate bias;      ///< mean difference, radiance; its error from the tries, 0 where there is but one
  MeanSquare square;  ///< of the differences per pixel, noise removed
};
/// Pairs the tries, so that noise which both share cancels. NaN where a pixel is not finite. @param pixels indices; at
/// least one
RungStep rung_step(const RungImage& from, const RungImage& to, const std::vector<size_t>& pixels);

/// Part of the image.
struct Region {
  std::string name;
  std::vector<size_t> pixels;
};

/// Settings that a ladder goes on to from the shipped ones.
struct LadderGoal {
  std::string name;  ///< whose they are
  Settings settings;
};

struct LadderOptions {
  int resolution = Settings().grid.resolution;  ///< of the shipped settings
  int width = 160;                              ///< pixels
  int tries = 8;                                ///< independent images of the rungs that are noisy, at least 2
  int spp = 64;                                 ///< paths, and rays, per pixel and try
  int marched_rays = 32;                        ///< per pixel and try, through the finest voxels
  int voxel_rays = 8;                           ///< per voxel, bounce and try; even
  int narrow_cones = 1024;
  std::optional<LadderGoal> goal{};  ///< none: the ladder ends with the shipped settings in bytes
};
/// What a full study takes, or one with --quick; without a goal.
LadderOptions ladder_options(bool quick);
/// The most memory that a ladder holds at once.
size_t ladder_bytes_per_pixel(const LadderOptions& options);
/// The shipped settings at the ladder's resolution, in the storage in which the goal's parameters follow.
Settings shipped_settings(const LadderOptions& options);

struct LadderClimb {
  std::vector<RungImage> rungs;       ///< one alone where paths find no light
  size_t shipped = 0;                 ///< the rung of the shipped settings; those of storages with fewer bits follow
  size_t first_parameter = 0;         ///< the first rung of the goal's parameters
  std::vector<double> direct;         ///< direct light that paths found, luminance per pixel
  std::vector<std::string> warnings;  ///< light that was not finite and that rungs therefore lack
};
/// The rungs from the path tracer to the shipped settings, down to the goal's storage, and on to the goal, parameter by
/// parameter (in the order of parameters(), but fewer bounces first): each is different from the one before in one
/// thing. All light (R,G,B) at the pixels' centres. @throws Interrupted
LadderClimb climb_ladder(const StudyScene& scene, const View& view, const LadderOptions& options,
                         const Progress& progress);

/// Whether the rungs before the goal's parameters, added up, are what separates their ends: both are rendered anew, the
/// path-traced one with another seed. A row per region; `p` is the probability of a gap at least as large by chance.
/// The rungs in between cancel in the sum: whether each is what its name says only tests can tell.
/// @param warnings gets what the ends had to leave out
Table closure(const StudyScene& scene, const View& view, const LadderOptions& options, const LadderClimb& climb,
              const std::vector<Region>& regions, std::vector<std::string>& warnings, const Progress& progress);

/// @param users somebody else's rendering of the scene, as read_users_image returns it: the last rung, and its size the
/// ladder's
Section ladder_section(const StudyScene& scene, const LadderOptions& options, const std::optional<Image>& users,
                       const Progress& progress);

}  // namespace voxref
