#pragma once
#include <utility>
#include <variant>

#include "cone/raw_gather.h"

namespace voxref {

/// Filtered light and opacity, in the form that `cone.opacity` and `storage` ask for.
using LitVolume = std::variant<Medium, Pyramid, Pyramid16, Pyramid8>;

/// Takes the pyramid's memory over.
template <class Texel>
LitVolume lit_volume(BasicPyramid<Texel>&& pyramid, ConeOpacity opacity, MipmapFilter filter) {
  if (opacity == ConeOpacity::raw) return std::move(pyramid);
  return make_medium(std::move(pyramid), filter);
}

/// Gathers with cones through extinction (spec section 5, radiometric).
class ExtinctionGatherer {
 public:
  /// Keeps a reference to the medium.
  ExtinctionGatherer(const Medium& medium, ConeSet diffuse, const GatherOptions& options);

  DiffuseGather diffuse(const GatherPoint& point) const;
  glm::vec3 specular(const GatherPoint& point, const glm::vec3& to_viewer, float tan_half_angle) const;
  float visibility(const GatherPoint& point, const Light& light, const Illumination& lit) const;

 private:
  const Medium& medium_;
  ConeSet diffuse_;
  GatherOptions options_;
};

/// What a pixel's surface receives through cones, whatever they march through.
class Gatherer {
 public:
  /// Keeps a reference to the volume.
  Gatherer(const LitVolume& volume, const GatherOptions& options);

  DiffuseGather diffuse(const GatherPoint& point) const;
  /// Mean radiance in the cone along the mirror direction of `to_viewer` (unit).
  glm::vec3 specular(const GatherPoint& point, const glm::vec3& to_viewer, float tan_half_angle) const;
  /// Share of a light that arrives through a cone, in [0,1].
  float visibility(const GatherPoint& point, const Light& light, const Illumination& lit) const;

 private:
  std::variant<ExtinctionGatherer, RawGatherer<glm::vec4>, RawGatherer<Rgba16f>, RawGatherer<Rgba8>> gatherer_;
};

}  // namespace voxref
