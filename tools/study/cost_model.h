#pragma once
#include <map>
#include <vector>

#include "pipeline.h"
#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

/// What a unit of each stage's work takes, seconds.
struct StageRates {
  double voxelize = 1e-6;       ///< per occupied voxel
  double shade = 4e-7;          ///< per occupied voxel, filtering included
  double look_up = 6e-8;        ///< per look-up of a cone at a voxel
  double prepare = 1e-7;        ///< per occupied voxel
  double pixel_look_up = 6e-8;  ///< per look-up of a cone at a pixel, with its share of what the pixel itself takes
};

/// How surfaces see each other, from rays in cosine-distributed directions off points that are spread evenly over the
/// scene's area; the same numbers each time.
struct Visibility {
  double hit_share = 0.0;      ///< of the rays that meet a surface
  double mean_distance = 0.0;  ///< to it, world units
};
Visibility measure_visibility(const Scene& scene, const Caster& caster);

/// Predicts the time of settings on one scene from counted work: occupied voxels, cones and their look-ups. A cone of
/// half-angle a that is marched with steps of k texels makes, until it has gone D voxels, 1 / (2 k tan a) look-ups
/// while its texels are single voxels and ln(2 D tan a) / ln(1 + 2 k tan a) after that.
///
/// What a unit of work takes is the median over those runs that are most like the setting in question; counts likewise
/// come from the run of the nearest resolution.
class CostModel {
 public:
  /// @param rates where no run has told
  CostModel(const Visibility& visibility, const StageRates& rates) : visibility_(visibility), rates_(rates) {}

  /// Takes what a run counted (voxels, bounces) and, where asked, how long each stage took. @param pixels of its image
  void learn(const Settings& settings, const ConeTraceResult& result, size_t pixels, bool times);

  /// Seconds for an image of so many pixels. @throws std::logic_error before anything was learned
  StageSeconds predict(const Settings& settings, size_t pixels) const;

  static double look_ups(double tan_half_angle, double step, double distance_in_voxels);

 private:
  struct Work {
    double voxels, bounce_look_ups, pixel_look_ups;
  };
  struct Count {
    double voxels, voxel_side;
    int auto_bounces;  // 0: unknown
  };
  struct Sample {
    Settings settings;
    StageRates rates;  // NaN where the run had none of that work
  };
  Work work(const Settings& settings, size_t pixels) const;
  StageRates rates(const Settings& settings) const;

  Visibility visibility_;
  StageRates rates_;
  std::map<int, Count> counts_;  // per resolution
  std::vector<Sample> samples_;
};

}  // namespace voxref
