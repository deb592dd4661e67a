#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cone/gather.h"
#include "scene/caster.h"
#include "scene/surface.h"
#include "voxel/brick_volume.h"
#include "voxel/voxelize.h"

namespace voxref {

/// What a pixel sees, for gathers that are no stage of the cone tracer: rays in place of cones.
struct SeenPoint {
  bool surface = false;  ///< false: the camera looks out of the scene
  GatherPoint point;     ///< where cones would start, clear of what is near
  SurfacePoint shading;
  glm::vec3 to_viewer{0.0f};  ///< unit
  bool contact = false;       ///< another surface is within three voxels over this one's plane
};

/// One per pixel, row by row, at its centre. @param voxel side, world units
std::vector<SeenPoint> see(const Scene& scene, const Caster& caster, const View& view, const ConeOptions& cone,
                           float voxel);

/// Radiance that comes to a surface point from `direction` (unit).
using IncomingRadiance = std::function<glm::vec3(const GatherPoint& from, const glm::vec3& direction)>;

/// Light that the surface scatters towards the viewer, per pixel: mean over `rays` directions drawn from its BSDF.
/// @param seed images of different seeds are independent, also of bounce_by_rays
std::vector<glm::vec3> gather_rays(const std::vector<SeenPoint>& seen, const View& view, int rays, uint64_t seed,
                                   const IncomingRadiance& incoming, const Progress& progress);

/// The same surfaces with the diffuse part of their BSDF alone.
std::vector<SeenPoint> without_specular(std::vector<SeenPoint> seen);

/// What VoxelRadiance looks up. @param radiance one per occupied voxel, W/(sr m^2)
BrickVolume<glm::vec4> voxel_volume(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance);

/// Radiance of voxels, looked up where a true ray hits a triangle: in that voxel, or, where rounding puts the hit
/// beyond its face, in the nearest occupied neighbour.
class VoxelRadiance {
 public:
  /// @param base premultiplied radiance and opacity, or any positive multiple of both; kept by reference
  VoxelRadiance(const Caster& caster, const Grid& grid, const BrickVolume<glm::vec4>& base, const glm::vec3& background)
      : caster_(caster), grid_(grid), base_(base), background_(background) {}

  glm::vec3 operator()(const GatherPoint& from, const glm::vec3& direction) const;

 private:
  glm::vec3 at(const glm::vec3& position) const;

  const Caster& caster_;
  Grid grid_;
  const BrickVolume<glm::vec4>& base_;
  glm::vec3 background_;
};

/// Voxel radiance after `count` bounces, each gathered with true rays from the voxels' centroids and looked up in the
/// voxels: what bounce() does with cones. One per occupied voxel; right in the mean for any number of rays.
/// @param rays per voxel and bounce, even: surfaces that show both sides divide them
/// @param seed results of different seeds are independent, also of gather_rays
std::vector<glm::vec3> bounce_by_rays(const SurfaceGrid& surfaces, const std::vector<glm::vec3>& direct,
                                      const Caster& caster, const glm::vec3& background, int count, int rays,
                                      uint64_t seed, const Progress& progress);

}  // namespace voxref
