#pragma once
#include <optional>
#include <string>

#include "pipeline.h"

namespace voxref {

/// Cone traces one scene from one camera with many settings, in a row. Settings that share a voxelization, or a lit and
/// filtered volume, with those before them reuse it; each gets the seconds booked that its stages took when they ran.
class ConeRunner {
 public:
  /// Keeps references to scene and caster.
  ConeRunner(const Scene& scene, const Caster& caster, const View& view, const Progress& progress = {})
      : scene_(scene), caster_(caster), view_(view), progress_(progress) {}

  /// The same bits as cone_trace(). @throws Error as that
  ConeTraceResult operator()(const Settings& settings) { return (*this)(settings, view_); }
  /// The same from another camera, or of another size. @param view with the same background
  ConeTraceResult operator()(const Settings& settings, const View& view);

  /// Seconds that the last call spent; of a stage whose result was there from one before it, 0.
  const StageSeconds& ran() const { return ran_; }
  /// Those of all calls: each stage counts as often as it ran.
  double spent() const { return spent_; }

 private:
  const SurfaceGrid& surfaces(const Settings& settings);
  const LitVoxels& lit(const Settings& settings);

  const Scene& scene_;
  const Caster& caster_;
  View view_;
  Progress progress_;
  std::string surfaces_of_, lit_of_;  // the parameters that they depend on, as text
  SurfaceGrid surfaces_;
  double voxelize_seconds_ = 0.0, spent_ = 0.0;
  StageSeconds ran_;
  std::optional<LitVoxels> lit_;
};

}  // namespace voxref
