#include "cone/gatherer.h"

#include <glm/geometric.hpp>
#include <utility>

namespace voxref {
namespace {

template <class Volume>
inline constexpr bool is_medium = false;
template <class Texel>
inline constexpr bool is_medium<BasicMedium<Texel>> = true;

}  // namespace

std::optional<float> extinction_voxel(const LitVolume& volume) {
  return std::visit(
      [](const auto& v) -> std::optional<float> {
        if constexpr (is_medium<std::decay_t<decltype(v)>>)
          return v.texels.grid.voxel;
        else
          return std::nullopt;
      },
      volume);
}

template <class Texel>
ExtinctionGatherer<Texel>::ExtinctionGatherer(const BasicMedium<Texel>& medium, ConeSet diffuse,
                                              const GatherOptions& options)
    : medium_(medium), diffuse_(std::move(diffuse)), options_(options) {}

template <class Texel>
DiffuseGather ExtinctionGatherer<Texel>::diffuse(const GatherPoint& point) const {
  return gather_diffuse(medium_, diffuse_, point, options_.cone, options_.ao, options_.background);
}

template <class Texel>
glm::vec3 ExtinctionGatherer<Texel>::specular(const GatherPoint& point, const glm::vec3& to_viewer,
                                              float tan_half_angle) const {
  return gather_specular(medium_, point, to_viewer, tan_half_angle, options_.cone, options_.background);
}

template <class Texel>
float ExtinctionGatherer<Texel>::visibility(const GatherPoint& point, const Light& light,
                                            const Illumination& lit) const {
  const Grid& grid = medium_.texels.grid;
  const bool directional = light.type == LightType::directional;  // then to a point outside the grid
  const glm::vec3 target =
      directional ? point.position + glm::length(grid.max() - grid.min) * lit.to_light : light.position;
  return gather_visibility(medium_, point, target, options_.shadow_aperture, options_.cone);
}

Gatherer::Gatherer(const LitVolume& volume, const GatherOptions& options)
    : gatherer_(std::visit(
          [&](const auto& v) -> decltype(gatherer_) {
            ConeSet diffuse = pixel_cones(options.cone.diffuse);
            if constexpr (is_medium<std::decay_t<decltype(v)>>)
              return ExtinctionGatherer(v, std::move(diffuse), options);
            else
              return RawGatherer(v, std::move(diffuse), options);
          },
          volume)) {}

DiffuseGather Gatherer::diffuse(const GatherPoint& point) const {
  return std::visit([&](const auto& gatherer) { return gatherer.diffuse(point); }, gatherer_);
}

glm::vec3 Gatherer::specular(const GatherPoint& point, const glm::vec3& to_viewer, float tan_half_angle) const {
  return std::visit([&](const auto& gatherer) { return gatherer.specular(point, to_viewer, tan_half_angle); },
                    gatherer_);
}

float Gatherer::visibility(const GatherPoint& point, const Light& light, const Illumination& lit) const {
  return std::visit([&](const auto& gatherer) { return gatherer.visibility(point, light, lit); }, gatherer_);
}

}  // namespace voxref
