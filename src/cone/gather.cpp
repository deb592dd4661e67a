#include "cone/gather.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace voxref {
namespace {

/// A cone's apex over a surface, so far out that the surface's own voxels no longer count.
struct Apex {
  glm::vec3 position;
  OwnPlane own;
};

template <class Texel>
Apex apex_over(const BasicMedium<Texel>& medium, const GatherPoint& point, const ConeOptions& options) {
  const float voxel = medium.texels.grid.voxel;
  const glm::vec3 lift = apex_height(point.geometric_normal, options) * point.geometric_normal + point.aside / voxel;
  return {point.position + voxel * lift, {point.geometric_normal, lift}};
}

}  // namespace

float openness(float occlusion, const AoOptions& options) {
  if (!options.enabled || options.alpha >= 1.0f) return 1.0f;  // all of it is given back, however much it sums to
  const float total = options.normalized ? std::numbers::pi_v<float> : 1.0f;
  return std::clamp(1.0f - occlusion / total + options.alpha, 0.0f, 1.0f);
}

float apex_height(const glm::vec3& normal, const ConeOptions& options) {
  // The surface's voxels and the filter are cubes: they reach furthest, by the 1-norm, along a diagonal normal.
  return options.start * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
}

template <class Texel>
DiffuseGather gather_diffuse(const BasicMedium<Texel>& medium, const ConeSet& cones, const GatherPoint& point,
                             const ConeOptions& options, const AoOptions& ao, const glm::vec3& background) {
  const Apex apex = apex_over(medium, point, options);
  const glm::mat3 frame = cones.frame(point.shading_normal);
  const glm::ivec3& size = medium.texels.grid.size;
  MarchOptions march_options{options.step, background};
  if (ao.enabled) march_options.falloff = ao.falloff / static_cast<float>(std::max({size.x, size.y, size.z}));

  DiffuseGather result;
  float occlusion = 0.0f;
  for (const Cone& cone : cones.cones) {
    const glm::vec3 direction = frame * cone.direction;
    if (glm::dot(direction, point.geometric_normal) <= 0.0f) {
      occlusion += cone.weight;
      continue;
    }
    march_options.texel = cone.texel;
    const ConeSample seen = march(medium, apex.position, direction, cone.tan_half_angle, apex.own, march_options);
    result.irradiance += cone.weight * seen.radiance;
    occlusion += cone.weight * seen.occlusion;
  }
  result.openness = openness(occlusion, ao);
  return result;
}

template <class Texel>
glm::vec3 gather_specular(const BasicMedium<Texel>& medium, const GatherPoint& point, const glm::vec3& to_viewer,
                          float tan_half_angle, const ConeOptions& options, const glm::vec3& background) {
  const glm::vec3 mirrored = glm::reflect(-to_viewer, point.shading_normal);
  if (glm::dot(mirrored, point.geometric_normal) <= 0.0f) return glm::vec3(0.0f);
  const Apex apex = apex_over(medium, point, options);
  return march(medium, apex.position, mirrored, tan_half_angle, apex.own, {options.step, background}).radiance;
}

template <class Texel>
float gather_visibility(const BasicMedium<Texel>& medium, const GatherPoint& point, const glm::vec3& target,
                        float tan_half_angle, const ConeOptions& options) {
  return 1.0f - march_opacity(medium, apex_over(medium, point, options).position, target, tan_half_angle, options.step);
}

template DiffuseGather gather_diffuse(const Medium&, const ConeSet&, const GatherPoint&, const ConeOptions&,
                                      const AoOptions&, const glm::vec3&);
template glm::vec3 gather_specular(const Medium&, const GatherPoint&, const glm::vec3&, float, const ConeOptions&,
                                   const glm::vec3&);
template float gather_visibility(const Medium&, const GatherPoint&, const glm::vec3&, float, const ConeOptions&);
template DiffuseGather gather_diffuse(const Medium16&, const ConeSet&, const GatherPoint&, const ConeOptions&,
                                      const AoOptions&, const glm::vec3&);
template glm::vec3 gather_specular(const Medium16&, const GatherPoint&, const glm::vec3&, float, const ConeOptions&,
                                   const glm::vec3&);
template float gather_visibility(const Medium16&, const GatherPoint&, const glm::vec3&, float, const ConeOptions&);
template DiffuseGather gather_diffuse(const Medium8&, const ConeSet&, const GatherPoint&, const ConeOptions&,
                                      const AoOptions&, const glm::vec3&);
template glm::vec3 gather_specular(const Medium8&, const GatherPoint&, const glm::vec3&, float, const ConeOptions&,
                                   const glm::vec3&);
template float gather_visibility(const Medium8&, const GatherPoint&, const glm::vec3&, float, const ConeOptions&);

}  // namespace voxref
