#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "reference/light_sampling.h"
#include "reference/sampler.h"
#include "scene/caster.h"
#include "scene/surface.h"

namespace voxref {

/// What one path, or the mean of many, brings to a pixel: radiance by the number of times the light was scattered.
struct Layers {
  glm::vec3 emission{0.0f};  ///< 0: sources and the background, seen directly
  glm::vec3 direct{0.0f};    ///< 1: straight from a source to what the camera sees
  glm::vec3 indirect{0.0f};  ///< 2 and more

  glm::vec3& scattered(int times) { return times == 0 ? emission : times == 1 ? direct : indirect; }
};

/// Where a path meets a surface.
struct PathVertex {
  /// @param ray unit direction; the one that hit
  PathVertex(const Surfaces& surfaces, const Hit& hit, const Ray& ray)
      : to_previous(-ray.direction), distance(hit.t), surface(surfaces.point(hit, to_previous)) {}

  glm::vec3 to_previous;  ///< unit, towards the vertex before
  float distance;         ///< from there, world units
  SurfacePoint surface;
};

/// Which light transport is estimated.
struct Transport {
  std::optional<int> max_depth;      ///< as PathOptions::max_depth
  bool energy_compensation = false;  ///< as PathOptions::energy_compensation
};

/// Counted along the way; integers, so that their sum does not depend on the order.
struct PathCounts {
  uint64_t closest_rays = 0, occlusion_rays = 0;
  uint64_t nonfinite = 0;  ///< contributions that were NaN or infinite and were left out
};

/// Estimates the rendering equation (thesis eq. 1.17) along single paths, from the camera: at each vertex the light is
/// sampled (next-event estimation) and the BSDF is; where both find emissive triangles, they are weighed by the power
/// heuristic (Veach and Guibas 1995). Immutable, keeps references; any number of threads may trace at once.
class Integrator {
 public:
  Integrator(const Scene& scene, const Surfaces& surfaces, const Caster& caster, const glm::vec3& background,
             const Transport& transport);

  /// Sets `vertex` to what a ray (unit direction) finds; none where it leaves the scene. In place: copying what was
  /// just written costs more than the copy.
  void cast(const Ray& ray, std::optional<PathVertex>& vertex, PathCounts& counts) const;
  /// One path on from what the camera sees; dimension 0 of the sampler is left to the caller.
  Layers trace(const std::optional<PathVertex>& seen, const Sampler& sampler, PathCounts& counts) const;

 private:
  struct State;
  glm::vec3 emitted(const State& state) const;
  void add_punctual(State& state, const class Bsdf& bsdf) const;
  void add_emitters(State& state, const class Bsdf& bsdf) const;
  bool scatter(State& state, const class Bsdf& bsdf) const;

  const Surfaces& surfaces_;
  const Caster& caster_;
  LightSampler lights_;
  glm::vec3 background_;
  int max_depth_;
  bool compensates_;
  bool light_can_be_hit_;  // there are emissive surfaces or a background
};

}  // namespace voxref
