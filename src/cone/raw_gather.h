#pragma once
#include <vector>

#include "cone/gather.h"
#include "cone/raw_march.h"
#include "cone/raw_volume.h"
#include "scene/light.h"

namespace voxref {

/// What gathering at pixels depends on besides the volumes.
struct GatherOptions {
  ConeOptions cone;
  AoOptions ao;
  float shadow_aperture = 0.03f;  ///< tangent of the half-angle of cones to lights
  float shadow_tolerance = 0.1f;  ///< t: raw shadow cones multiply opacity by 2^(7 t); 1: whatever is there is black
  glm::vec3 background{0.0f};     ///< radiance of what leaves the volumes; raw cones do not see it
  Bounds box;                     ///< that raw cones must meet
  float farthest_light = 0.0f;    ///< of any point that may ask for it, world units
};

/// Gathers with raw cones (spec section 5, villegas2016). With w = ConeOptions::raw_unit in world units, a cone starts
/// at p + w n and takes its first sample at distance w from there; a shadow cone starts at p + w l and takes its first
/// sample at 2 w from p, but counts distance from its start, so that it overshoots the light by up to w.
template <class Texel>
class RawGatherer {
 public:
  /// Keeps a reference to the volume.
  RawGatherer(const BasicRawVolume<Texel>& volume, ConeSet diffuse, const GatherOptions& options);

  DiffuseGather diffuse(const GatherPoint& point) const;
  glm::vec3 specular(const GatherPoint& point, const glm::vec3& to_viewer, float tan_half_angle) const;
  float visibility(const GatherPoint& point, const Light& light, const Illumination& lit) const;

 private:
  /// @param end world units
  ConeSteps steps(float tan_half_angle, float end) const;
  bool misses_box(const GatherPoint& point, const glm::vec3& direction) const;
  RawCone march(const GatherPoint& point, const glm::vec3& direction, const ConeSteps& steps) const;

  const BasicPyramid<Texel>& pyramid_;
  const Occupancy& occupied_;
  ConeSet diffuse_;
  GatherOptions options_;
  float side_, unit_, end_;               // the grid's longest side; w; where cones end; world units
  std::vector<ConeSteps> diffuse_steps_;  // one per cone
  ConeSteps shadow_steps_;
};

}  // namespace voxref
