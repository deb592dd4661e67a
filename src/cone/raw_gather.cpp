#include "cone/raw_gather.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

namespace voxref {

template <class Texel>
RawGatherer<Texel>::RawGatherer(const BasicRawVolume<Texel>& volume, ConeSet diffuse, const GatherOptions& options)
    : pyramid_(volume.texels), occupied_(volume.occupied), diffuse_(std::move(diffuse)), options_(options) {
  const Grid& grid = pyramid_.grid;
  side_ = grid.voxel * static_cast<float>(std::max({grid.size.x, grid.size.y, grid.size.z}));
  unit_ = grid.voxel * options.cone.raw_unit;
  // Beyond the box's diagonal every cone has left it.
  end_ =
      options.cone.max_distance ? *options.cone.max_distance * side_ : grid.voxel * glm::length(glm::vec3(grid.size));
  for (const Cone& cone : diffuse_.cones) diffuse_steps_.push_back(steps(cone.tan_half_angle, end_));
  shadow_steps_ = steps(options.shadow_aperture, std::max(options.farthest_light, side_));
}

template <class Texel>
ConeSteps RawGatherer<Texel>::steps(float tan_half_angle, float end) const {
  ConeStepping stepping;
  stepping.unit = unit_;
  stepping.step = options_.cone.step;
  stepping.end = end;
  stepping.top = static_cast<int>(pyramid_.levels.size());
  stepping.falloff = options_.ao.enabled ? options_.ao.falloff / side_ : 0.0f;
  return {cone_steps(tan_half_angle, stepping), pyramid_.grid.voxel};
}

template <class Texel>
bool RawGatherer<Texel>::misses_box(const GatherPoint& point, const glm::vec3& direction) const {
  return options_.cone.box_test && !meets(options_.box, point.position, direction);
}

template <class Texel>
RawCone RawGatherer<Texel>::march(const GatherPoint& point, const glm::vec3& direction, const ConeSteps& steps) const {
  if (misses_box(point, direction)) return {};
  const Grid& grid = pyramid_.grid;
  const glm::vec3 start = point.position + options_.cone.start * grid.voxel * point.geometric_normal;
  return march_raw(pyramid_, occupied_, ConeAxis(grid, start, direction), steps);
}

template <class Texel>
DiffuseGather RawGatherer<Texel>::diffuse(const GatherPoint& point) const {
  const glm::mat3 frame = diffuse_.frame(point.shading_normal);
  DiffuseGather result;
  float occlusion = 0.0f;
  for (size_t i = 0; i < diffuse_.cones.size(); ++i) {
    const Cone& cone = diffuse_.cones[i];
    const RawCone seen = march(point, glm::normalize(frame * cone.direction), diffuse_steps_[i]);
    result.irradiance += cone.weight * seen.radiance;
    occlusion += cone.weight * seen.occlusion;
  }
  result.openness = openness(occlusion, options_.ao);
  return result;
}

template <class Texel>
glm::vec3 RawGatherer<Texel>::specular(const GatherPoint& point, const glm::vec3& to_viewer,
                                       float tan_half_angle) const {
  const glm::vec3 mirrored = glm::normalize(glm::reflect(-to_viewer, point.shading_normal));
  return march(point, mirrored, steps(tan_half_angle, end_)).radiance;
}

template <class Texel>
float RawGatherer<Texel>::visibility(const GatherPoint& point, const Light& light, const Illumination& lit) const {
  if (misses_box(point, lit.to_light)) return 0.0f;
  const float end = light.type == LightType::directional ? side_ : lit.distance;
  const float gain = options_.shadow_tolerance == 1.0f ? std::numeric_limits<float>::infinity()
                                                       : std::exp2(7.0f * options_.shadow_tolerance);
  const ConeAxis axis(pyramid_.grid, point.position + unit_ * lit.to_light, lit.to_light);
  return march_raw_shadow(pyramid_, occupied_, axis, shadow_steps_, end, gain);
}

template class RawGatherer<glm::vec4>;
template class RawGatherer<Rgba16f>;
template class RawGatherer<Rgba8>;

}  // namespace voxref
