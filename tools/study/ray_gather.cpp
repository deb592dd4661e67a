#include "study/ray_gather.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "cone/clearance.h"
#include "parallel.h"
#include "reference/bsdf.h"
#include "reference/sampler.h"
#include "reference/warp.h"
#include "scene/surface.h"

namespace voxref {

namespace {

constexpr size_t grain = 64;  // pixels or voxels per task

// Numbers of the randomizations (see randomization_key), so that pixels and voxels never share one.
constexpr uint32_t of_pixels = 0, of_voxels = 1;

/// Whether rays that rise gently all around meet something within `reach`.
bool near_contact(const Caster& caster, const glm::vec3& position, const glm::vec3& normal, float reach) {
  constexpr int directions = 8;
  const Frame frame(normal);
  for (int i = 0; i < directions; ++i) {
    const glm::vec2 turn = cos_sin_of_turns(float(i) / directions);
    Ray ray = caster.leave(position, normal, glm::normalize(frame.to_world({turn, 0.2f})));
    ray.tmax = reach;
    if (caster.occluded(ray)) return true;
  }
  return false;
}

}  // namespace

std::vector<SeenPoint> see(const Scene& scene, const Caster& caster, const View& view, const ConeOptions& cone,
                           float voxel) {
  const Surfaces surfaces(scene);
  const RayGenerator rays(view);
  const auto width = static_cast<size_t>(view.width);
  std::vector<SeenPoint> seen(width * static_cast<size_t>(view.height));
  parallel_for(seen.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Ray ray = rays({float(i % width) + 0.5f, float(i / width) + 0.5f});
      const Hit hit = caster.closest(ray);
      if (!hit) continue;
      SeenPoint& s = seen[i];
      s.surface = true;
      s.to_viewer = -ray.direction;
      s.shading = surfaces.point(hit, s.to_viewer);
      s.point = {s.shading.position, s.shading.geometric_normal, s.shading.shading_normal};
      s.point.aside = clearance(scene, caster, s.point.position, s.point.geometric_normal, cone, voxel);
      s.contact = near_contact(caster, s.point.position, s.point.geometric_normal, 3.0f * voxel);
    }
  });
  return seen;
}

std::vector<glm::vec3> gather_rays(const std::vector<SeenPoint>& seen, const View& view, int rays, uint64_t seed,
                                   const IncomingRadiance& incoming, const Progress& progress) {
  std::vector<glm::vec3> light(seen.size());
  const auto width = static_cast<size_t>(view.width);
  parallel_for(seen.size(), grain, [&](size_t begin, size_t end) {
    progress.check();
    for (size_t i = begin; i < end; ++i) {
      if (!seen[i].surface) continue;
      const Bsdf bsdf(seen[i].shading, seen[i].to_viewer);
      const uint64_t key = randomization_key(seed, uint32_t(i % width), uint32_t(i / width), of_pixels);
      glm::vec3 sum(0.0f);
      for (int r = 0; r < rays; ++r) {
        const Sampler sampler(key, uint32_t(r));
        if (const auto sample = bsdf.sample(sampler.get_1d(0), sampler.get_2d(1)))
          sum += sample.weight * incoming(seen[i].point, sample.in);
      }
      light[i] = sum / float(rays);
    }
  });
  return light;
}

std::vector<SeenPoint> without_specular(std::vector<SeenPoint> seen) {
  for (SeenPoint& s : seen) s.shading.reflectance.specular_f0 = s.shading.reflectance.specular_f1 = glm::vec3(0.0f);
  return seen;
}

BrickVolume<glm::vec4> voxel_volume(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance) {
  BrickVolume<glm::vec4> volume(surfaces.grid.size);
  volume.allocate(occupied_bricks(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i) volume(surfaces.voxels[i]) = glm::vec4(radiance[i], 1.0f);
  return volume;
}

glm::vec3 VoxelRadiance::at(const glm::vec3& position) const {
  const glm::vec3 p = grid_.to_voxels(position);
  const glm::ivec3 home(glm::floor(p));
  if (const glm::vec4& texel = base_(home); texel.a > 0.0f) return glm::vec3(texel) / texel.a;
  glm::vec4 nearest(0.0f);
  float least = 4.0f;  // above any squared distance to a neighbour's box
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 v = home + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    const glm::vec3 away = p - glm::clamp(p, glm::vec3(v), glm::vec3(v + 1));
    if (base_(v).a > 0.0f && glm::dot(away, away) < least) {
      least = glm::dot(away, away);
      nearest = base_(v);
    }
  }
  return nearest.a > 0.0f ? glm::vec3(nearest) / nearest.a : glm::vec3(0.0f);
}

glm::vec3 VoxelRadiance::operator()(const GatherPoint& from, const glm::vec3& direction) const {
  const Ray ray = caster_.leave(from.position, from.geometric_normal, direction);
  const Hit hit = caster_.closest(ray);
  return hit ? at(ray.origin + hit.t * direction) : background_;
}

std::vector<glm::vec3> bounce_by_rays(const SurfaceGrid& surfaces, const std::vector<glm::vec3>& direct,
                                      const Caster& caster, const glm::vec3& background, int count, int rays,
                                      uint64_t seed, const Progress& progress) {
  std::vector<glm::vec3> radiance = direct;
  for (int b = 0; b < count; ++b) {
    const BrickVolume<glm::vec4> volume = voxel_volume(surfaces, radiance);
    const VoxelRadiance incoming(caster, surfaces.grid, volume, background);
    parallel_for(surfaces.size(), grain, [&](size_t begin, size_t end) {
      progress.check();
      for (size_t i = begin; i < end; ++i) {
        const float length = glm::length(surfaces.normal[i]);
        const glm::vec3 front = length > 0.0f ? surfaces.normal[i] / length : glm::vec3(0.0f, 1.0f, 0.0f);
        const bool both_sides = length < two_sided_length;
        const uint64_t key = randomization_key(seed, uint32_t(i), uint32_t(b), of_voxels);
        glm::vec3 sum(0.0f);
        for (int r = 0; r < rays; ++r) {
          const glm::vec3 normal = both_sides && r % 2 == 1 ? -front : front;
          const Sampler sampler(key, uint32_t(r));
          // Half a voxel off the surface, as shading's shadow rays.
          const glm::vec3 start = surfaces.centroid[i] + 0.5f * surfaces.grid.voxel * normal;
          sum += incoming({start, normal, normal, {}}, Frame(normal).to_world(cosine_hemisphere(sampler.get_2d(0))));
        }
        radiance[i] = direct[i] + glm::vec3(surfaces.albedo[i]) * sum / float(rays);
      }
    });
  }
  return radiance;
}

}  // namespace voxref
