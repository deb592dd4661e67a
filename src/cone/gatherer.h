#pragma once
#include <optional>
#include <utility>
#include <variant>

#include "cone/raw_gather.h"

namespace voxref {

/// Filtered light and opacity, in the form that `cone.opacity` and `storage` ask for.
using LitVolume = std::variant<Medium, Medium16, Medium8, RawVolume, RawVolume16, RawVolume8>;

/// Takes the pyramid's memory over.
template <class Texel>
LitVolume lit_volume(BasicPyramid<Texel>&& pyramid, ConeOpacity opacity, MipmapFilter filter) {
  if (opacity == ConeOpacity::raw) return std::move(pyramid);
  return make_medium(std::move(pyramid), filter);
}

/// Side of a voxel where cones go through extinction, world units; none where they are raw.
std::optional<float> extinction_voxel(const LitVolume& volume);

/// Gathers with cones through extinction (spec section 5, radiometric).
template <class Texel>
class ExtinctionGatherer {
 public:
  /// Keeps a reference to the medium.
  ExtinctionGatherer(const BasicMedium<Texel>& medium, ConeSet diffuse, const GatherOptions& options);

  DiffuseGather diffuse(const GatherPoint& point) const;
  glm::vec3 specular(const GatherPoint& point, const glm::vec3& to_viewer, float tan_half_angle) const;
  float visibility(const GatherPoint& point, const Light& light, const Illumination& lit) const;

 private:
  const BasicMedium<Texel>& medium_;
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
  std::variant<ExtinctionGatherer<glm::vec4>, ExtinctionGatherer<Rgba16f>, ExtinctionGatherer<Rgba8>,
               RawGatherer<glm::vec4>, RawGatherer<Rgba16f>, RawGatherer<Rgba8>>
      gatherer_;
};

}  // namespace voxref
