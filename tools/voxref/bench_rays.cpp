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
#include "scene/surface.h"

namespace voxref {

namespace {

/// Draws points that are uniform over the area of a scene's emissive triangles.
class EmitterSampler {
 public:
  explicit EmitterSampler(const Scene& scene) : scene_(scene) {
    double area = 0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
      if (!scene.materials[scene.triangle_materials[i]].emissive()) continue;
      triangles_.push_back(i);
      area_up_to_.push_back(area += glm::length(cross_product(i)));
    }
  }

  bool empty() const { return area_up_to_.empty() || !(area_up_to_.back() > 0); }

  glm::vec3 operator()(std::mt19937_64& random) const {
    const double at = area_up_to_.back() * uniform(random);
    const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, at);
    const glm::uvec3 corners = scene_.triangles[triangles_[static_cast<size_t>(found - area_up_to_.begin())]];
    const float root = std::sqrt(static_cast<float>(uniform(random)));  // Osada et al. 2002, section 4.2
    const float v = root * static_cast<float>(uniform(random));
    return (1 - root) * scene_.positions[corners.x] + (root - v) * scene_.positions[corners.y] +
           v * scene_.positions[corners.z];
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

glm::vec3 cosine_direction(const glm::vec3& normal, std::mt19937_64& random) {
  const float radius = std::sqrt(static_cast<float>(EmitterSampler::uniform(random)));
  const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(EmitterSampler::uniform(random));
  const glm::vec3 local(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - radius * radius));
  return frame_around(normal) * local;
}

/// From a surface to a light picked at random; there must be one.
Ray shadow_ray(const Scene& scene, const Caster& caster, const SurfacePoint& from, const EmitterSampler& emitters,
               std::mt19937_64& random) {
  const size_t choices = scene.lights.size() + (emitters.empty() ? 0 : 1);
  const size_t chosen = random() % choices;
  if (chosen < scene.lights.size() && scene.lights[chosen].type == LightType::directional)
    return caster.leave(from.position, from.geometric_normal, -scene.lights[chosen].direction);
  const glm::vec3 target = chosen < scene.lights.size() ? scene.lights[chosen].position : emitters(random);
  constexpr float just_before = 0.999f;  // so that an emitter does not shadow itself
  const glm::vec3 origin = from.position + caster.surface_offset() * from.geometric_normal;
  return {origin, target - origin, 0.0f, just_before};
}

float largest(const glm::vec3& v) { return std::max({v.r, v.g, v.b}); }

}  // namespace

std::vector<BareRay> walk_rays(const Scene& scene, const Caster& caster, const View& view, size_t count,
                               double occlusion_share) {
  const EmitterSampler emitters(scene);
  if (occlusion_share > 0 && scene.lights.empty() && emitters.empty())
    throw Error(scene.file, "has no light to cast rays to");
  const Surfaces surfaces(scene);
  const RayGenerator camera(view);
  std::mt19937_64 random(1);
  std::vector<BareRay> rays;
  rays.reserve(count);
  const size_t pixels = static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
  double owed = 0.0;  // shadow rays, for those closest-hit rays that were cast
  size_t misses = 0;  // pixels in a row that see nothing
  for (size_t pixel = 0; rays.size() < count; pixel = (pixel + 1) % pixels) {
    const size_t column = pixel % static_cast<size_t>(view.width), row = pixel / static_cast<size_t>(view.width);
    Ray ray = camera(glm::vec2(column, row) + 0.5f);
    Hit hit = caster.closest(ray);
    misses = hit ? 0 : misses + 1;
    if (misses == pixels) throw Error(scene.file, "has no surface in view to cast rays from");
    while (hit && rays.size() < count) {
      const SurfacePoint point = surfaces.point(hit, -ray.direction);
      for (owed += occlusion_share / (1.0 - occlusion_share); owed >= 1.0; owed -= 1.0)
        rays.push_back({shadow_ray(scene, caster, point, emitters, random), true});
      ray = caster.leave(point.position, point.geometric_normal, cosine_direction(point.geometric_normal, random));
      hit = caster.closest(ray);
      rays.push_back({ray, false});
      if (EmitterSampler::uniform(random) >= largest(hemispherical_albedo(point.reflectance))) break;
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

double arithmetic_seconds() {
  constexpr size_t pieces = 256, steps = size_t{1} << 20;
  std::atomic<uint32_t> sum = 0;  // what nobody uses the compiler would leave out
  const auto start = std::chrono::steady_clock::now();
  parallel_for(pieces, 1, [&](size_t piece, size_t) {
    uint32_t x = static_cast<uint32_t>(piece) | 1u;
    for (size_t i = 0; i < steps; ++i) {  // xorshift, Marsaglia 2003: each step waits for the one before
      x ^= x << 13;
      x ^= x >> 17;
      x ^= x << 5;
    }
    sum += x;
  });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace voxref
