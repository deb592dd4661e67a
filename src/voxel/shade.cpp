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
#include "voxel/shadow_volume.h"

namespace voxref {

namespace {

/// A voxel's surface as a light sees it.
struct Facing {
  float cosine = 0.0f;   ///< mean of max(n.l, 0)
  glm::vec3 side{0.0f};  ///< unit, off the surface on the side that is lit
};

/// A voxel's normal, unit; zero where it has none.
glm::vec3 unit(const glm::vec3& normal) { return normal == glm::vec3(0.0f) ? normal : glm::normalize(normal); }

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

/// sum over axes of n_a^2 max(sign(n_a) l_a, 0), in place of max(n.l, 0): thesis 2.2. Right only in the mean over light
/// directions; at l = n it returns between 0.58 and 1 of n.l. @param n, l unit
float normal_weighted(const glm::vec3& n, const glm::vec3& l) {
  const auto axis = [](float n_a, float l_a) {
    return (n_a > 0.0f ? std::max(l_a, 0.0f) : std::max(-l_a, 0.0f)) * (n_a * n_a);
  };
  return axis(n.x, l.x) + axis(n.y, l.y) + axis(n.z, l.z);
}

class Shader {
 public:
  Shader(const Scene& scene, const Caster* caster, const SurfaceGrid& surfaces, const LightOptions& light,
         const ShadeOptions& options)
      : lights_(by_type(scene.lights)), caster_(caster), surfaces_(surfaces), light_options_(light), options_(options) {
    assert(caster || options.shadow != VoxelShadow::rays);
    if (options.shadow != VoxelShadow::volume) return;
    if (options.shadow_hit)
      shadow_volume_.emplace(surfaces);
    else
      medium_ = make_opacity_medium(surfaces);
  }

  void operator()(size_t voxel, Shading& shading) const {
    const glm::vec4& albedo = surfaces_.albedo[voxel];
    if (albedo.a == 0.0f) return;  // reads as empty
    glm::vec3 reflected(0.0f);
    float visible = 0.0f;
    if (glm::vec3(albedo) != glm::vec3(0.0f)) {
      for (const Light& light : lights_) {
        const glm::vec3 position = shaded_point(voxel);
        const Illumination arriving = illuminate(light, position, light_options_);
        if (arriving.attenuation == 0.0f) continue;
        const Facing surface = facing(voxel, arriving.to_light);
        // Rays that change nothing are not cast; the published march, which does, says what light would be visible.
        if (!(surface.cosine > 0.0f) && (caster_shadow() || medium_)) continue;
        const float share = visibility(light, arriving, position, surface.side);
        reflected += light.intensity * glm::vec3(albedo) * surface.cosine * arriving.attenuation * share;
        visible += share;
      }
    }
    if (options_.normalization == ShadeNormalization::lambert) reflected *= std::numbers::inv_pi_v<float>;
    const glm::vec3 emission = surfaces_.emission.empty() ? glm::vec3(0.0f) : surfaces_.emission[voxel];
    shading.radiance[voxel] = emission + reflected;
    const float lights = float(std::max<size_t>(lights_.size(), 1));
    shading.visibility[voxel] = std::clamp(visible / lights, 0.0f, 1.0f);
  }

  /// Of the volume that shadows are marched through.
  size_t shadow_bytes() const { return shadow_volume_ ? shadow_volume_->bytes() : medium_ ? medium_->bytes() : 0; }

 private:
  bool caster_shadow() const { return options_.shadow == VoxelShadow::rays; }

  glm::vec3 shaded_point(size_t voxel) const {
    if (options_.position == ShadePosition::centroid) return surfaces_.centroid[voxel];
    const Grid& grid = surfaces_.grid;
    const glm::vec3 corner = glm::vec3(surfaces_.voxels[voxel]) * grid.voxel + grid.min;
    return corner + unit(surfaces_.normal[voxel]) * (0.5f * grid.voxel);
  }

  // Light from behind counts as none: a voxel has one radiance for all directions, and what shone on the outside of a
  // wall would glow inside the room.
  Facing facing(size_t voxel, const glm::vec3& to_light) const {
    const glm::vec3& mean_normal = surfaces_.normal[voxel];
    if (options_.two_sided && glm::length(mean_normal) < two_sided_length) return {0.5f, to_light};
    const glm::vec3 normal = unit(mean_normal);
    const float cosine =
        options_.normal_weighted ? normal_weighted(normal, to_light) : std::max(glm::dot(normal, to_light), 0.0f);
    return {cosine, normal};
  }

  /// Share of a light that reaches a voxel; in [0,1] but for directional lights, which the published march can turn
  /// negative.
  float visibility(const Light& light, const Illumination& arriving, const glm::vec3& position,
                   const glm::vec3& side) const {
    if (shadow_volume_) return published_visibility(light, arriving, position);
    if (options_.shadow == VoxelShadow::none) return 1.0f;
    const Grid& grid = surfaces_.grid;
    const float offset = grid.voxel * (caster_shadow() ? ray_offset(side) : march_offset(side));
    const glm::vec3 from = position + offset * side;
    const bool directional = light.type == LightType::directional;
    if (caster_shadow()) {
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

  float published_visibility(const Light& light, const Illumination& arriving, const glm::vec3& position) const {
    const Grid& grid = surfaces_.grid;
    const float scale = 1.0f / (grid.voxel * float(std::max({grid.size.x, grid.size.y, grid.size.z})));
    const glm::vec3 from = (position - grid.min) * scale;
    const float hit = *options_.shadow_hit;
    if (light.type == LightType::directional)  // not clamped at 0, by an oversight of the published shader
      return shadow_volume_->visibility(from, arriving.to_light, 1.0f, hit);
    const glm::vec3 offset = (light.position - grid.min) * scale - from;
    const float distance = glm::length(offset);
    return std::max(0.0f, shadow_volume_->visibility(from, glm::normalize(offset), distance, hit));
  }

  std::vector<Light> lights_;  // in the published order of sums
  const Caster* caster_;
  const SurfaceGrid& surfaces_;
  LightOptions light_options_;
  ShadeOptions options_;
  std::optional<ShadowVolume> shadow_volume_;
  std::optional<Medium> medium_;
};

}  // namespace

Shading shade(const Scene& scene, const Caster* caster, const SurfaceGrid& surfaces, const LightOptions& light,
              const ShadeOptions& options, const Progress& progress) {
  const Shader shader(scene, caster, surfaces, light, options);
  Shading shading{std::vector<glm::vec3>(surfaces.size()), std::vector<float>(surfaces.size()), shader.shadow_bytes()};
  std::atomic<size_t> finished = 0;
  parallel_for(surfaces.size(), 1024, [&](size_t begin, size_t end) {
    progress.check();
    for (size_t i = begin; i < end; ++i) shader(i, shading);
    progress("shade", double(finished += end - begin) / double(surfaces.size()));
  });
  return shading;
}

}  // namespace voxref
