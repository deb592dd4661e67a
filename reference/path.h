#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "image/image.h"
#include "progress.h"
#include "reference/checkpoint.h"
#include "reference/extra_layers.h"
#include "reference/tiles.h"
#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

struct PathOptions {
  int spp = 64;  ///< samples per pixel; with noise or seconds: the most that is taken, 0 = no limit
  /// Independent randomizations among which a known number of samples is divided, whose scatter is the standard error.
  /// Fewer are better stratified, and so less noisy, but know their error less well; one does not know it at all.
  int randomizations = 16;
  std::optional<double>
      noise;  ///< stop when mean standard error / mean value, as luminance over the image, is at most this
  std::optional<double> seconds;  ///< stop after this time
  std::optional<int>
      max_depth;  ///< 0: emission only, 1: direct, 2: one indirect bounce ...; none: Russian roulette alone
  bool energy_compensation =
      false;  ///< of the GGX lobe, which glTF defines with single scattering: compensate_energy()
  uint64_t seed = 0;
  ExtraLayers extra;
  Part part;  ///< with a known number of samples only: parts cannot agree on when to stop. See merge.h
  CheckpointOptions checkpoint;
};

struct PathResult {
  Image image;  ///< layers of cli.md for `path`, plus stderr.Y and stderr.indirect.Y (luminance)
  glm::vec3 mean{0.0f}, mean_stderr{0.0f};  ///< of R,G,B over the image
  int spp = 0;                              ///< samples taken per pixel
  double seconds = 0;                       ///< of the render loop
  uint64_t rays = 0;                        ///< closest-hit plus occlusion rays of the render loop
  uint64_t closest_rays = 0, occlusion_rays = 0;
  uint64_t nonfinite = 0;       ///< contributions that were NaN or infinite; they are left out of the sums
  std::string first_nonfinite;  ///< "pixel (x, y) sample n", empty when there is none
  bool interrupted = false;     ///< stopped by the caller: `spp` is what there was time for
};

/// Path traces the view: unidirectional, next-event estimation with multiple importance sampling, Russian roulette. The
/// result is the same bits whatever the number of threads, and however often the render was killed and resumed (but
/// with `seconds`, whose number of samples is a matter of luck). Outside the part that was asked for all is zero.
/// @throws Interrupted when stopped before the first samples
PathResult path_trace(const Scene& scene, const Caster& caster, const View& view, const PathOptions& options,
                      const Progress& progress = {});

}  // namespace voxref
