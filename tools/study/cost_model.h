#pragma once
#include <map>
#include <vector>

#include "pipeline.h"
#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

/// What a unit of each stage's work takes, seconds. Unless said otherwise as in the Cornell box with a point light at
/// 64 voxels, float32, steps of a half and of one, 6 cones, 48 pixels' width: the least of 12 runs on one core (AVX2).
struct StageRates {
  double voxelize = 3.6e-7;       ///< per occupied voxel
  double shade = 1.3e-7;          ///< per occupied voxel, filtering included
  double look_up = 2.3e-7;        ///< per look-up of a cone at a voxel
  double prepare = 1.1e-6;        ///< per occupied voxel
  double pixel_look_up = 1.7e-7;  ///< per look-up of a cone at a pixel, with its share of what the pixel itself takes
  double image = 0.0;             ///< per image, whatever its size: what is made ready for all of its pixels
};

/// Mean distance from surface to surface: of rays in cosine-distributed directions, to both sides, off points that are
/// spread evenly over the scene's area, those that meet one; the same each time. World units; 0 where none does.
double mean_sight(const Scene& scene, const Caster& caster);

/// Predicts the time of settings on one scene from counted work: occupied voxels, cones and their look-ups. A cone of
/// half-angle a that is marched with steps of k texels makes, until it has gone D voxels, 1 / (2 k tan a) look-ups
/// while its texels are single voxels and ln(2 D tan a) / ln(1 + 2 k tan a) after that.
///
/// What a unit of a stage's work takes is the median over those times that it ran with parameters most like the wanted
/// ones, of which only those count that the stage depends on; counts likewise come from the run of the nearest
/// resolution.
class CostModel {
 public:
  /// @param sight see mean_sight @param rates of stages that no run has told of
  CostModel(double sight, const StageRates& rates) : sight_(sight), rates_(rates) {}

  /// Takes the seconds of an image of hardly any pixels, so that later runs' pixels are not charged with them. Of a
  /// later image that took no longer its pixels' rate is not learned.
  void learn_image(double seconds);
  /// Takes what a run counted (voxels, bounces) and how long its stages took. @param pixels of its image
  /// @param ran seconds of each stage that ran for it; 0: it did not, and its result was there from an earlier run,
  /// whose time must not count twice
  void learn(const Settings& settings, const ConeTraceResult& result, size_t pixels, const StageSeconds& ran);

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
  using Stage = double StageRates::*;
  /// One run of one stage.
  struct Sample {
    Stage stage;
    Settings settings;
    double rate;
  };
  Work work(const Settings& settings, size_t pixels) const;
  double rate(Stage stage, const Settings& settings) const;

  double sight_;
  StageRates rates_;
  std::map<int, Count> counts_;  // per resolution
  std::vector<Sample> samples_;
};

}  // namespace voxref
