#include "reference/integrator.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "reference/bsdf.h"

namespace voxref {

namespace {

/// Dimension sets of the sampler that one vertex uses; set 0 is the position in the pixel.
enum Dimension : uint32_t { choose_punctual, choose_emitter, point_on_emitter, choose_lobe, bsdf_direction, roulette };
constexpr uint32_t dimensions_per_vertex = 6;

// Russian roulette starts at the third surface, so that the first indirect bounce, which most images consist of, is
// always there. Survival is the throughput's largest channel, which makes all surviving paths weigh about the same. It
// is capped: between perfectly white walls a path would never end otherwise.
constexpr int roulette_start = 2;
constexpr float most_survival = 0.98f;

float largest(const glm::vec3& v) { return std::max({v.r, v.g, v.b}); }
bool finite(const glm::vec3& v) { return std::isfinite(v.r + v.g + v.b); }

/// Power heuristic, exponent 2, for one sample of each of two strategies: weight of the first.
float power_heuristic(float pdf, float other) {
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace

/// A path under way.
struct Integrator::State {
  const Sampler& sampler;
  PathCounts& counts;
  PathVertex vertex;
  Layers layers;
  glm::vec3 throughput{1.0f};  // product of BSDF x cosine / pdf so far
  float bsdf_pdf = 0.0f;       // with which the vertex was found, per solid angle; 0: by the camera
  int depth = 0;               // surfaces before this vertex

  uint32_t dimension(Dimension set) const { return 1 + static_cast<uint32_t>(depth) * dimensions_per_vertex + set; }
  /// Radiance that was scattered `times` times on its way to the camera.
  void add(int times, const glm::vec3& radiance) {
    if (finite(radiance))
      layers.scattered(times) += radiance;
    else
      ++counts.nonfinite;
  }
};

Integrator::Integrator(const Scene& scene, const Caster& caster, const glm::vec3& background,
                       std::optional<int> max_depth)
    : scene_(scene),
      caster_(caster),
      lights_(scene),
      background_(background),
      max_depth_(max_depth.value_or(std::numeric_limits<int>::max())),
      light_can_be_hit_(scene.has_emission() || background != glm::vec3(0.0f)) {}

PathVertex Integrator::cast(const Ray& ray, PathCounts& counts) const {
  ++counts.rays;
  const Hit hit = caster_.closest(ray);
  PathVertex vertex{std::nullopt, -ray.direction, hit.t};
  if (hit) vertex.surface = surface_point(scene_, hit, vertex.to_previous);
  return vertex;
}

Layers Integrator::trace(const PathVertex& camera_vertex, const Sampler& sampler, PathCounts& counts) const {
  State state{sampler, counts, camera_vertex, {}};
  for (;; ++state.depth) {
    if (!state.vertex.surface) {
      state.add(state.depth, state.throughput * background_);
      break;
    }
    const SurfacePoint& surface = *state.vertex.surface;
    if (surface.emission != glm::vec3(0.0f)) state.add(state.depth, state.throughput * emitted(state));
    if (state.depth >= max_depth_ || surface.reflectance.black()) break;

    const Bsdf bsdf(surface, state.vertex.to_previous);
    if (lights_.has_punctual()) add_punctual(state, bsdf);
    if (lights_.has_emitters()) add_emitters(state, bsdf);
    // The last ray can only find light itself.
    if (state.depth + 1 == max_depth_ && !light_can_be_hit_) break;
    if (!scatter(state, bsdf)) break;
  }
  return state.layers;
}

/// Emission of the vertex, weighed against the chance that the vertex before had sampled it as a light.
glm::vec3 Integrator::emitted(const State& state) const {
  const SurfacePoint& surface = *state.vertex.surface;
  if (state.bsdf_pdf == 0.0f) return surface.emission;
  const float light_pdf = lights_.emitter_pdf(surface.triangle, state.vertex.to_previous, state.vertex.distance);
  return power_heuristic(state.bsdf_pdf, light_pdf) * surface.emission;
}

void Integrator::add_punctual(State& state, const Bsdf& bsdf) const {
  const SurfacePoint& surface = *state.vertex.surface;
  const uint32_t bits = state.sampler.bits_1d(state.dimension(choose_punctual));
  const std::optional<PunctualSample> light = lights_.sample_punctual(surface.position, surface.shading_normal, bits);
  if (!light) return;
  const glm::vec3 radiance = bsdf.value(light->to_light) * light->irradiance;
  if (radiance == glm::vec3(0.0f)) return;
  Ray ray = caster_.leave(surface.position, surface.geometric_normal, light->to_light);
  ray.tmax = light->distance;
  ++state.counts.rays;
  if (!caster_.occluded(ray)) state.add(state.depth + 1, state.throughput * radiance);
}

void Integrator::add_emitters(State& state, const Bsdf& bsdf) const {
  const SurfacePoint& surface = *state.vertex.surface;
  const std::optional<EmitterSample> light =
      lights_.sample_emitter(surface.position, state.sampler.bits_1d(state.dimension(choose_emitter)),
                             state.sampler.get_2d(state.dimension(point_on_emitter)));
  if (!light) return;
  const glm::vec3 radiance = bsdf.value(light->to_light) * light->radiance;
  if (radiance == glm::vec3(0.0f)) return;
  const float offset = caster_.surface_offset();
  ++state.counts.rays;
  if (!caster_.visible(surface.position + offset * surface.geometric_normal, light->position + offset * light->normal))
    return;
  const float weight = power_heuristic(light->pdf, bsdf.pdf(light->to_light));
  state.add(state.depth + 1, state.throughput * radiance * (weight / light->pdf));
}

/// Goes on to the next vertex. False where the path ends.
bool Integrator::scatter(State& state, const Bsdf& bsdf) const {
  const float choice = bsdf.chooses() ? state.sampler.get_1d(state.dimension(choose_lobe)) : 0.0f;
  const std::optional<BsdfSample> next = bsdf.sample(choice, state.sampler.get_2d(state.dimension(bsdf_direction)));
  if (!next) return false;
  state.throughput *= next->weight;
  if (!finite(state.throughput)) {
    ++state.counts.nonfinite;
    return false;
  }
  // From the throughput alone, never from the light: twice the light then gives exactly twice the image.
  if (state.depth >= roulette_start) {
    const float survival = std::min(largest(state.throughput), most_survival);
    if (state.sampler.get_1d(state.dimension(roulette)) >= survival) return false;
    state.throughput /= survival;
  }
  state.bsdf_pdf = next->pdf;
  const SurfacePoint& surface = *state.vertex.surface;
  state.vertex = cast(caster_.leave(surface.position, surface.geometric_normal, next->in), state.counts);
  return true;
}

}  // namespace voxref
