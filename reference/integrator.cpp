#include "reference/integrator.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "reference/bsdf.h"

namespace voxref {

namespace {

/// Dimension sets of the sampler that one vertex uses; set 0 is the position in the pixel.
enum Dimension : uint32_t { choose_punctual, point_on_emitter, choose_lobe, bsdf_direction, roulette };
constexpr uint32_t dimensions_per_vertex = 5;

// Russian roulette keeps paths from carrying much less than half of what they set out with: survival is twice the
// throughput's largest channel. Measured on the Cornell box, roulette at a half gives 10 to 20 % less squared error in
// the same time than at one. It spares the first bounce, which most images consist of. Between perfectly white walls a
// path would never end; from the 32nd surface on every one loses at least 2 %.
constexpr float least_throughput = 0.5f;
constexpr int long_path = 32;
constexpr float most_survival_of_long = 0.98f;

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
  std::optional<PathVertex> vertex;  // none: outside the scene
  Layers layers;
  glm::vec3 throughput{1.0f};  // product of BSDF x cosine / pdf so far
  float bsdf_pdf = 0.0f;       // with which the vertex was found, per solid angle; 0: by the camera
  int depth = 0;               // surfaces before this vertex
  Receiver previous{};         // the vertex before this one, where there is one

  uint32_t dimension(Dimension set) const { return 1 + static_cast<uint32_t>(depth) * dimensions_per_vertex + set; }
  /// Radiance that was scattered `times` times on its way to the camera.
  void add(int times, const glm::vec3& radiance) {
    if (finite(radiance))
      layers.scattered(times) += radiance;
    else
      ++counts.nonfinite;
  }
};

Integrator::Integrator(const Scene& scene, const Surfaces& surfaces, const Caster& caster, const glm::vec3& background,
                       const Transport& transport)
    : surfaces_(surfaces),
      caster_(caster),
      lights_(scene, surfaces.materials()),
      background_(background),
      max_depth_(transport.max_depth.value_or(std::numeric_limits<int>::max())),
      compensates_(transport.energy_compensation),
      light_can_be_hit_(scene.has_emission() || background != glm::vec3(0.0f)) {}

void Integrator::cast(const Ray& ray, std::optional<PathVertex>& vertex, PathCounts& counts) const {
  ++counts.closest_rays;
  if (const Hit hit = caster_.closest(ray))
    vertex.emplace(surfaces_, hit, ray);
  else
    vertex.reset();
}

Layers Integrator::trace(const std::optional<PathVertex>& seen, const Sampler& sampler, PathCounts& counts) const {
  State state{sampler, counts, seen, {}};
  for (;; ++state.depth) {
    if (!state.vertex) {
      state.add(state.depth, state.throughput * background_);
      break;
    }
    SurfacePoint& surface = state.vertex->surface;
    if (compensates_)
      compensate_energy(surface.reflectance, glm::dot(surface.shading_normal, state.vertex->to_previous));
    if (surface.emission != glm::vec3(0.0f)) state.add(state.depth, state.throughput * emitted(state));
    if (state.depth >= max_depth_ || surface.reflectance.black()) break;

    const Bsdf bsdf(surface, state.vertex->to_previous);
    if (lights_.punctual_count() > 0) add_punctual(state, bsdf);
    if (lights_.has_emitters()) add_emitters(state, bsdf);
    // The last ray can only find light itself.
    if (state.depth + 1 == max_depth_ && !light_can_be_hit_) break;
    if (!scatter(state, bsdf)) break;
  }
  return state.layers;
}

/// Emission of the vertex, weighed against the chance that the vertex before had sampled it as a light.
glm::vec3 Integrator::emitted(const State& state) const {
  const SurfacePoint& surface = state.vertex->surface;
  if (state.bsdf_pdf == 0.0f) return surface.emission;
  const float light_pdf =
      lights_.emitter_pdf(state.previous, surface.triangle, state.vertex->to_previous, state.vertex->distance);
  return power_heuristic(state.bsdf_pdf, light_pdf) * surface.emission;
}

void Integrator::add_punctual(State& state, const Bsdf& bsdf) const {
  const SurfacePoint& surface = state.vertex->surface;
  const uint32_t bits = lights_.punctual_count() > 1 ? state.sampler.bits_1d(state.dimension(choose_punctual)) : 0;
  const std::optional<PunctualSample> light = lights_.sample_punctual({surface.position, surface.shading_normal}, bits);
  if (!light) return;
  const glm::vec3 radiance = bsdf.value(light->to_light) * light->irradiance;
  if (radiance == glm::vec3(0.0f)) return;
  Ray ray = caster_.leave(surface.position, surface.geometric_normal, light->to_light);
  ray.tmax = light->distance;
  ++state.counts.occlusion_rays;
  if (!caster_.occluded(ray)) state.add(state.depth + 1, state.throughput * radiance);
}

void Integrator::add_emitters(State& state, const Bsdf& bsdf) const {
  const SurfacePoint& surface = state.vertex->surface;
  const std::optional<EmitterSample> light = lights_.sample_emitter(
      {surface.position, surface.shading_normal}, state.sampler.bits_2d(state.dimension(point_on_emitter)));
  if (!light) return;
  const glm::vec3 radiance = bsdf.value(light->to_light) * light->radiance;
  if (radiance == glm::vec3(0.0f)) return;
  const float offset = caster_.surface_offset();
  ++state.counts.occlusion_rays;
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
  if (state.depth > 0) {
    const float most = state.depth < long_path ? 1.0f : most_survival_of_long;
    const float survival = std::min(largest(state.throughput) / least_throughput, most);
    if (survival < 1.0f) {
      if (state.sampler.get_1d(state.dimension(roulette)) >= survival) return false;
      state.throughput /= survival;
    }
  }
  state.bsdf_pdf = next->pdf;
  const SurfacePoint& surface = state.vertex->surface;
  state.previous = {surface.position, surface.shading_normal};
  cast(caster_.leave(surface.position, surface.geometric_normal, next->in), state.vertex, state.counts);
  return true;
}

}  // namespace voxref
