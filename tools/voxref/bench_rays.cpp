#include "bench_rays.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "cone/cone_set.h"
#include "error.h"
#include "parallel.h"

namespace voxref {

namespace {

/// Draws points that are uniform over the area of some triangles of a scene.
class AreaSampler {
 public:
  AreaSampler(const Scene& scene, std::vector<uint32_t> triangles) : scene_(scene), triangles_(std::move(triangles)) {
    double area = 0;
    for (const uint32_t triangle : triangles_) area_up_to_.push_back(area += glm::length(cross_product(triangle)));
  }

  bool empty() const { return area_up_to_.empty() || !(area_up_to_.back() > 0); }

  struct Sample {
    glm::vec3 point, normal;
  };
  Sample operator()(std::mt19937_64& random) const {
    const double at = area_up_to_.back() * uniform(random);
    const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, at);
    const uint32_t triangle = triangles_[static_cast<size_t>(found - area_up_to_.begin())];
    const glm::uvec3 corners = scene_.triangles[triangle];
    const float root = std::sqrt(static_cast<float>(uniform(random)));  // Osada et al. 2002, section 4.2
    const float v = root * static_cast<float>(uniform(random));
    return {(1 - root) * scene_.positions[corners.x] + (root - v) * scene_.positions[corners.y] +
                v * scene_.positions[corners.z],
            glm::normalize(cross_product(triangle))};
  }

  static double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

 private:
  glm::vec3 cross_product(uint32_t triangle) const {
    const glm::uvec3 corners = scene_.triangles[triangle];
    const glm::vec3 a = scene_.positions[corners.x];
    return glm::cross(scene_.positions[corners.y] - a, scene_.positions[corners.z] - a);
  }

  const Scene& scene_;
  std::vector<uint32_t> triangles_;
  std::vector<double> area_up_to_;
};

AreaSampler sampler_of(const Scene& scene, bool emissive_only) {
  std::vector<uint32_t> triangles;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i)
    if (!emissive_only || scene.materials[scene.triangle_materials[i]].emissive()) triangles.push_back(i);
  return {scene, std::move(triangles)};
}

glm::vec3 cosine_direction(const glm::vec3& normal, std::mt19937_64& random) {
  const float radius = std::sqrt(static_cast<float>(AreaSampler::uniform(random)));
  const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(AreaSampler::uniform(random));
  const glm::vec3 local(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - radius * radius));
  return frame_around(normal) * local;
}

/// From a point to a light picked at random; there must be one.
Ray shadow_ray(const Scene& scene, const Caster& caster, const AreaSampler::Sample& from, const AreaSampler& emitters,
               std::mt19937_64& random) {
  const size_t choices = scene.lights.size() + (emitters.empty() ? 0 : 1);
  const size_t chosen = random() % choices;
  if (chosen < scene.lights.size() && scene.lights[chosen].type == LightType::directional)
    return caster.leave(from.point, from.normal, -scene.lights[chosen].direction);
  const glm::vec3 target = chosen < scene.lights.size() ? scene.lights[chosen].position : emitters(random).point;
  const glm::vec3 side = glm::dot(target - from.point, from.normal) < 0 ? -from.normal : from.normal;
  constexpr float just_before = 0.999f;  // so that an emitter does not shadow itself
  const glm::vec3 origin = from.point + caster.surface_offset() * side;
  return {origin, target - origin, 0.0f, just_before};
}

}  // namespace

std::vector<BareRay> incoherent_rays(const Scene& scene, const Caster& caster, size_t count, double occlusion_share) {
  const AreaSampler everywhere = sampler_of(scene, false);
  if (everywhere.empty()) throw Error(scene.file, "has no surface to cast rays from");
  const AreaSampler emitters = sampler_of(scene, true);
  if (occlusion_share > 0 && scene.lights.empty() && emitters.empty())
    throw Error(scene.file, "has no light to cast rays to");
  std::mt19937_64 random(1);
  std::vector<BareRay> rays;
  rays.reserve(count);
  AreaSampler::Sample from = everywhere(random);
  for (size_t i = 0; i < count; ++i) {
    const double before = occlusion_share * static_cast<double>(i);
    if (std::floor(before + occlusion_share) > std::floor(before)) {
      rays.push_back({shadow_ray(scene, caster, from, emitters, random), true});
    } else {
      from = everywhere(random);
      rays.push_back({caster.leave(from.point, from.normal, cosine_direction(from.normal, random)), false});
    }
  }
  return rays;
}

double cast_seconds(const Caster& caster, const std::vector<BareRay>& rays, uint64_t count) {
  constexpr size_t grain = 4096;
  std::atomic<uint64_t> hits = 0;  // so that the compiler cannot leave the casting out
  const auto begin = std::chrono::steady_clock::now();
  parallel_for(count, grain, [&](size_t first, size_t last) {
    uint64_t found = 0;
    for (size_t i = first; i < last; ++i) {
      const auto& [ray, occlusion] = rays[i % rays.size()];
      found += static_cast<uint64_t>(occlusion ? caster.occluded(ray) : static_cast<bool>(caster.closest(ray)));
    }
    hits.fetch_add(found, std::memory_order_relaxed);
  });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace voxref
