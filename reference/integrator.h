#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "reference/lanes.h"
#include "reference/light_sampling.h"
#include "reference/sampler.h"
#include "reference/sampler_block.h"
#include "reference/vertices.h"
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

/// A path to trace: from what the camera sees on, with random numbers of its own.
struct PathStart {
  const PathVertex* seen;  ///< null: the camera looks out of the scene
  Sampler sampler;         ///< its dimension 0 is left to the caller
};

/// What a path found.
struct PathSample {
  Layers layers;
  uint32_t nonfinite = 0;  ///< contributions that were NaN or infinite and were left out
};

/// Counted along the way; integers, so that their sum does not depend on the order.
struct PathCounts {
  uint64_t closest_rays = 0, occlusion_rays = 0;
  uint64_t nonfinite = 0;  ///< sum over the paths' samples
};

/// Paths on their way together. Kept between calls, so that nothing is allocated in the loop; large.
class Wave {
 public:
  static constexpr size_t most_paths = most_lanes;

  /// One per path, in the order of the starts; of the trace that was run last.
  std::span<const PathSample> samples() const { return samples_; }
  /// The light of path `i` that was scattered 2, 3, ... times, as far as was asked for.
  std::span<const glm::vec3> bounces(size_t i) const {
    return std::span(bounces_).subspan(i * bounces_each_, bounces_each_);
  }

 private:
  friend class Integrator;
  /// A path that goes on; they all have the same depth.
  struct Path {
    uint32_t start = 0;
    glm::vec3 throughput{1.0f};  // product of BSDF x cosine / pdf so far
    float bsdf_pdf = 0.0f;       // with which the vertex was found, per solid angle; 0: by the camera
    Receiver previous{};         // the vertex before, where there is one
  };
  /// Light that arrives unless something is in its way.
  struct Pending {
    uint32_t start = 0;
    glm::vec3 radiance{0.0f};
  };
  /// Random numbers of one set, for each of the vertices.
  struct Numbers {
    std::vector<uint32_t> x, y;
  };

  void begin(std::span<const PathStart> starts, size_t bounces_each);
  void draw();
  void add(uint32_t start, int times, const glm::vec3& radiance);
  void pend(size_t vertex, const Ray& shadow_ray);
  void weigh_by_light(bool against_bsdf);
  void weigh_by_bsdf(float least_survival, float most_survival);

  std::span<const PathStart> starts_;
  int depth_ = 0;  // surfaces before the present ones
  std::vector<PathSample> samples_;
  size_t bounces_each_ = 0;
  std::vector<glm::vec3> bounces_;
  size_t path_count_ = 0;  // of paths whose rays are under way; these are the first in each array
  std::array<Path, most_paths> paths_;
  std::array<Ray, most_paths> rays_;
  std::array<Hit, most_paths> hits_;

  // Side by side, of each path that scatters light at this depth:
  Vertices vertices_;
  Lanes<uint32_t> start_;
  Lanes3 throughput_;  // up to the vertex; once it is sampled, beyond it
  SamplerBlock samplers_;
  Numbers choose_punctual_, point_on_emitter_, choose_lobe_, bsdf_direction_, roulette_;
  LightLanes light_;
  Lanes3 scattered_;  // BSDF x cosine towards the light
  Lanes3 radiance_;   // that the light brings to the camera if it is seen
  Lanes3 next_;       // direction
  Lanes3 weight_;     // of that direction
  Lanes<float> pdf_;  // of the light's direction or the next one, by the BSDF
  Lanes<uint32_t> goes_on_;

  size_t pending_count_ = 0;
  std::array<Pending, most_paths> pending_;
  std::array<Ray, most_paths> shadow_rays_;
  std::array<uint8_t, most_paths> blocked_;
};

/// Estimates the rendering equation (thesis eq. 1.17) along paths from the camera: at each vertex the light is sampled
/// (next-event estimation) and the BSDF is; where both find emissive triangles, they are weighed by the power heuristic
/// (Veach and Guibas 1995). Immutable, keeps references; any number of threads may trace at once.
///
/// Many paths go from surface to surface in step, so that their rays are cast in packets, and what is done at each
/// vertex is done for several at once: see lanes.h.
class Integrator {
 public:
  /// @param bounces number of bounces whose light is kept apart, see Wave::bounces
  Integrator(const Scene& scene, const Surfaces& surfaces, const Caster& caster, const glm::vec3& background,
             const Transport& transport, int bounces = 0);

  /// Traces one path from each start, of which a wave takes most_paths. @param counts is added to
  void trace(std::span<const PathStart> starts, Wave& wave, PathCounts& counts) const;

 private:
  void arrive(Wave& wave, const Wave::Path& path, const PathVertex& vertex) const;
  void scatter(Wave& wave, PathCounts& counts) const;
  void add_punctual(Wave& wave) const;
  void add_emitters(Wave& wave) const;
  void go_on(Wave& wave) const;
  glm::vec3 leave(const Vertices& vertices, size_t i) const;
  glm::vec3 emitted(const Wave::Path& path, const PathVertex& vertex) const;
  void settle_shadows(Wave& wave, PathCounts& counts) const;
  void follow(Wave& wave, PathCounts& counts) const;

  const Surfaces& surfaces_;
  const Caster& caster_;
  LightSampler lights_;
  glm::vec3 background_;
  int max_depth_;
  bool compensates_;
  size_t bounces_;
  bool light_can_be_hit_;  // there are emissive surfaces or a background
};

}  // namespace voxref
