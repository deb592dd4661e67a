#include "cone/raw_bounce.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace voxref {

namespace {

constexpr float offset = 2.0f;  // voxels along the normal to the apex, and from there to the first sample

std::vector<ConeStep> steps_of(const Grid& grid, float tan_half_angle, size_t levels,
                               std::optional<float> max_distance) {
  const glm::vec3 size(grid.size);
  ConeStepping stepping;
  stepping.unit = offset;
  stepping.step = 1.0f;
  stepping.end = max_distance ? *max_distance * std::max({size.x, size.y, size.z}) : glm::length(size);
  stepping.top = static_cast<int>(levels);
  std::vector<ConeStep> steps = cone_steps(tan_half_angle, stepping);
  for (ConeStep& step : steps)
    if (step.level == 0) step = {step.distance, 1, 0.0f, 1.0f};  // never the base
  return steps;
}

/// normalize(n + a R + b U), summed as the shader sums it: another order moves a voxel in some twenty thousand by
/// 1/255.
glm::vec3 turned(const glm::mat3& frame, const Cone& cone) {
  const glm::vec3 d = cone.direction / cone.direction.z;
  return glm::normalize(frame[2] + (d.x * frame[0] + d.y * frame[1]));
}

}  // namespace

template <class Texel>
RawVoxelGatherer<Texel>::RawVoxelGatherer(const BasicRawVolume<Texel>& volume, std::optional<float> max_distance)
    : volume_(volume), cones_(voxel_cones(published_cones)) {
  const BasicPyramid<Texel>& pyramid = volume.texels;
  steps_ = {steps_of(pyramid.grid, cones_.cones.front().tan_half_angle, pyramid.levels.size(), max_distance), 1.0f};
}

template <class Texel>
glm::vec3 RawVoxelGatherer<Texel>::irradiance(const glm::ivec3& voxel, const glm::vec3& normal) const {
  const glm::mat3 frame = cones_.frame(normal);
  const glm::vec3 apex = glm::vec3(voxel) + offset * normal;
  glm::vec3 sum(0.0f);
  for (const Cone& cone : cones_.cones) sum += cone.weight * march(apex, turned(frame, cone));
  return glm::clamp(sum, 0.0f, 1.0f);
}

template <class Texel>
glm::vec3 RawVoxelGatherer<Texel>::march(const glm::vec3& apex, const glm::vec3& direction) const {
  if (steps_.size() == 0) return glm::vec3(0.0f);
  const ConeAxis axis(apex, direction);
  const glm::vec3 first(to_vec4(axis.origin + steps_[0].distance * axis.way)), size(volume_.texels.grid.size);
  if (glm::any(glm::lessThan(first, glm::vec3(0.0f))) || glm::any(glm::greaterThan(first, size)))
    return glm::vec3(0.0f);
  return march_raw(volume_.texels, volume_.occupied, axis, steps_).radiance;
}

template class RawVoxelGatherer<glm::vec4>;
template class RawVoxelGatherer<Rgba16f>;
template class RawVoxelGatherer<Rgba8>;

}  // namespace voxref
