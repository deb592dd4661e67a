#include "voxel/shade.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <span>

#include "cone/march.h"
#include "parallel.h"

namespace voxref {

namespace {

/// A voxel's surface as a light sees it.
struct Facing {
  float cosine = 0.0f;   ///< mean of max(n.l, 0)
  glm::vec3 side{0.0f};  ///< unit, off the surface on the side that is lit
};

// Light from behind counts as none: a voxel has one radiance for all directions, and what shone on the outside of a
// wall would glow inside the room.
Facing facing(const glm::vec3& mean_normal, const glm::vec3& to_light) {
  const float length = glm::length(mean_normal);
  if (length < two_sided_length) return {0.5f, to_light};
  const glm::vec3 normal = mean_normal / length;
  return {std::max(glm::dot(normal, to_light), 0.0f), normal};
}

// Where a shadow ray starts. At the centroid itself it could not: at a convex edge or corner the centroid lies inside
// the solid, between the faces, and on a curved surface below it. The ray starts off the surface instead, on the lit
// side, by half of the extent that a voxel has in that direction,
//
//   offset = h / 2 / max |side_a|,
//
// the distance from the centre of a cube to its boundary. That clears every edge and corner: with faces meeting in the
// voxel's far corner the centroid of the two strips of an edge is (3/4, 3/4) and that of the three squares of a corner
// (2/3, 2/3, 2/3); both move by 1/2 along each axis, out of the voxel. The price is that what casts a shadow from less
// than half a voxel above the surface is not seen, which the voxels cannot resolve anyway; and that a light nearer than
// that is reached from behind, which changes nothing for a ray between two free points.
float ray_offset(const glm::vec3& side) {
  return 0.5f / std::max({std::abs(side.x), std::abs(side.y), std::abs(side.z)});
}

/// The same for a march through the voxels: interpolation spreads the surface's own opacity by a voxel beyond the
/// occupied one, along each axis, which for a slanted surface adds up to the 1-norm of the direction.
float march_offset(const glm::vec3& side) { return 1.5f * (std::abs(side.x) + std::abs(side.y) + std::abs(side.z)); }

class Shader {
 public:
  Shader(const Scene& scene, const Caster* caster, const SurfaceGrid& surfaces, const LightOptions& light,
         VoxelShadow shadow)
      : scene_(scene), caster_(caster), surfaces_(surfaces), light_options_(light), shadow_(shadow) {
    assert(caster || shadow != VoxelShadow::rays);
    if (shadow == VoxelShadow::volume) medium_ = make_opacity_medium(surfaces);
  }

  void operator()(size_t voxel, Shading& shading) const {
    glm::vec3 irradiance(0.0f);
    float visible = 0.0f;
    for (const Light& light : scene_.lights) {
      const Illumination arriving = illuminate(light, surfaces_.centroid[voxel], light_options_);
      if (arriving.irradiance == glm::vec3(0.0f)) continue;
      const Facing surface = facing(surfaces_.normal[voxel], arriving.to_light);
      if (!(surface.cosine > 0.0f)) continue;
      const float share = visibility(light, voxel, surface.side);
      irradiance += surface.cosine * share * arriving.irradiance;
      visible += share;
    }
    const glm::vec3 emission = surfaces_.emission.empty() ? glm::vec3(0.0f) : surfaces_.emission[voxel];
    shading.radiance[voxel] =
        emission + glm::vec3(surfaces_.albedo[voxel]) * std::numbers::inv_pi_v<float> * irradiance;
    shading.visibility[voxel] = visible / std::max(1.0f, float(scene_.lights.size()));
  }

 private:
  /// Share of a light that reaches a voxel, in [0,1].
  float visibility(const Light& light, size_t voxel, const glm::vec3& side) const {
    if (shadow_ == VoxelShadow::none) return 1.0f;
    const Grid& grid = surfaces_.grid;
    const float offset = grid.voxel * (shadow_ == VoxelShadow::rays ? ray_offset(side) : march_offset(side));
    const glm::vec3 from = surfaces_.centroid[voxel] + offset * side;
    const bool directional = light.type == LightType::directional;
    if (shadow_ == VoxelShadow::rays) {
      const Ray ray = directional ? Ray{from, -light.direction} : Ray{from, light.position - from, 0.0f, 1.0f};
      return caster_->occluded(ray) ? 0.0f : 1.0f;
    }
    // From anywhere in the grid its diagonal leads out of it.
    const float diagonal = grid.voxel * glm::length(glm::vec3(grid.size));
    const glm::vec3 to = directional ? from - diagonal * light.direction : light.position;
    constexpr float line = 0.0f;  // a punctual light subtends no angle
    constexpr float step = 0.5f;  // voxels; half the width of the interpolation filter's tent
    return 1.0f - march_opacity(*medium_, from, to, line, step);
  }

  const Scene& scene_;
  const Caster* caster_;
  const SurfaceGrid& surfaces_;
  LightOptions light_options_;
  VoxelShadow shadow_;
  std::optional<Medium> medium_;
};

}  // namespace

Shading shade(const Scene& scene, const Caster* caster, const SurfaceGrid& surfaces, const LightOptions& light,
              const ShadeOptions& options, const Progress& progress) {
  const Shader shader(scene, caster, surfaces, light, options.shadow);
  Shading shading{std::vector<glm::vec3>(surfaces.size()), std::vector<float>(surfaces.size())};
  std::atomic<size_t> finished = 0;
  parallel_for(surfaces.size(), 1024, [&](size_t begin, size_t end) {
    progress.check();
    for (size_t i = begin; i < end; ++i) shader(i, shading);
    progress("shade", double(finished += end - begin) / double(surfaces.size()));
  });
  return shading;
}

}  // namespace voxref
