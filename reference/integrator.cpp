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

void Wave::begin(std::span<const PathStart> starts, size_t bounces_each) {
  starts_ = starts;
  depth_ = 0;
  samples_.assign(starts.size(), {});
  bounces_each_ = bounces_each;
  bounces_.assign(starts.size() * bounces_each, glm::vec3(0.0f));
  next_paths_.clear();
  paths_.assign(starts.size(), {});
  for (uint32_t i = 0; i < starts.size(); ++i) paths_[i].start = i;
  for (auto* list : {&rays_, &next_rays_, &shadow_rays_}) list->clear();
  pending_.clear();
  draw();
}

/// All random numbers of the paths at hand, whether they come to need them or not: made together, they cost little.
void Wave::draw() {
  samplers_.clear();
  for (const Path& path : paths_) samplers_.add(starts_[path.start].sampler);
  const auto dimension = [this](Dimension set) {
    return 1 + static_cast<uint32_t>(depth_) * dimensions_per_vertex + set;
  };
  samplers_.bits_1d(dimension(choose_punctual), choose_punctual_.x);
  samplers_.bits_2d(dimension(point_on_emitter), point_on_emitter_.x, point_on_emitter_.y);
  samplers_.bits_1d(dimension(choose_lobe), choose_lobe_.x);
  samplers_.bits_2d(dimension(bsdf_direction), bsdf_direction_.x, bsdf_direction_.y);
  samplers_.bits_1d(dimension(roulette), roulette_.x);
}

/// Radiance that was scattered `times` times on its way to the camera.
void Wave::add(uint32_t start, int times, const glm::vec3& radiance) {
  if (!finite(radiance)) {
    ++samples_[start].nonfinite;
    return;
  }
  samples_[start].layers.scattered(times) += radiance;
  if (const auto bounce = static_cast<size_t>(times - 2); bounce < bounces_each_)
    bounces_[start * bounces_each_ + bounce] += radiance;
}

/// Light that reaches the camera if nothing blocks the shadow ray that is to follow.
void Wave::pend(uint32_t start, const glm::vec3& radiance) {
  Pending& pending = pending_.emplace_back();
  pending.start = start;
  pending.radiance = radiance;
}

Integrator::Integrator(const Scene& scene, const Surfaces& surfaces, const Caster& caster, const glm::vec3& background,
                       const Transport& transport, int bounces)
    : surfaces_(surfaces),
      caster_(caster),
      lights_(scene, surfaces.materials()),
      background_(background),
      max_depth_(transport.max_depth.value_or(std::numeric_limits<int>::max())),
      compensates_(transport.energy_compensation),
      bounces_(static_cast<size_t>(bounces)),
      light_can_be_hit_(scene.has_emission() || background != glm::vec3(0.0f)) {}

void Integrator::trace(std::span<const PathStart> starts, Wave& wave, PathCounts& counts) const {
  wave.begin(starts, bounces_);
  for (uint32_t i = 0; i < starts.size(); ++i) {
    if (starts[i].seen)
      arrive(wave, i, *starts[i].seen);
    else
      wave.add(i, 0, background_);
  }
  settle_shadows(wave, counts);
  while (!wave.next_paths_.empty()) {
    follow(wave, counts);
    settle_shadows(wave, counts);
  }
  for (const PathSample& sample : wave.samples_) counts.nonfinite += sample.nonfinite;
}

/// Casts the rays of all paths that go on, and takes them to the surfaces that these find.
void Integrator::follow(Wave& wave, PathCounts& counts) const {
  std::swap(wave.paths_, wave.next_paths_);
  std::swap(wave.rays_, wave.next_rays_);
  wave.next_paths_.clear();
  wave.next_rays_.clear();
  ++wave.depth_;
  wave.hits_.resize(wave.rays_.size());
  caster_.closest(wave.rays_, wave.hits_);
  counts.closest_rays += wave.rays_.size();
  surfaces_.prefetch(wave.hits_);
  wave.draw();
  for (size_t i = 0; i < wave.paths_.size(); ++i) {
    if (wave.hits_[i])
      arrive(wave, i, PathVertex(surfaces_, wave.hits_[i], wave.rays_[i]));
    else
      wave.add(wave.paths_[i].start, wave.depth_, wave.paths_[i].throughput * background_);
  }
}

/// Light sampled at the present vertices arrives where nothing blocks it.
void Integrator::settle_shadows(Wave& wave, PathCounts& counts) const {
  wave.blocked_.resize(wave.shadow_rays_.size());
  caster_.occluded(wave.shadow_rays_, wave.blocked_);
  counts.occlusion_rays += wave.shadow_rays_.size();
  for (size_t i = 0; i < wave.pending_.size(); ++i)
    if (!wave.blocked_[i]) wave.add(wave.pending_[i].start, wave.depth_ + 1, wave.pending_[i].radiance);
  wave.shadow_rays_.clear();
  wave.pending_.clear();
}

void Integrator::arrive(Wave& wave, size_t i, const PathVertex& vertex) const {
  const Wave::Path& path = wave.paths_[i];
  const SurfacePoint& surface = vertex.surface;
  if (surface.emission != glm::vec3(0.0f)) wave.add(path.start, wave.depth_, path.throughput * emitted(path, vertex));
  if (wave.depth_ >= max_depth_ || surface.reflectance.black()) return;
  if (!compensates_) return scatter_light(wave, i, vertex);
  PathVertex compensated = vertex;
  compensate_energy(compensated.surface.reflectance, glm::dot(surface.shading_normal, vertex.to_previous));
  scatter_light(wave, i, compensated);
}

/// Light that the vertex scatters: straight from the lights, and what the path goes on to find.
void Integrator::scatter_light(Wave& wave, size_t i, const PathVertex& vertex) const {
  const Bsdf bsdf(vertex.surface, vertex.to_previous);
  if (lights_.punctual_count() > 0) add_punctual(wave, i, vertex, bsdf);
  if (lights_.has_emitters()) add_emitters(wave, i, vertex, bsdf);
  // The last ray can only find light itself.
  if (wave.depth_ + 1 < max_depth_ || light_can_be_hit_) scatter(wave, i, vertex, bsdf);
}

/// Emission of the vertex, weighed against the chance that the vertex before had sampled it as a light.
glm::vec3 Integrator::emitted(const Wave::Path& path, const PathVertex& vertex) const {
  if (path.bsdf_pdf == 0.0f) return vertex.surface.emission;
  const float light_pdf =
      lights_.emitter_pdf(path.previous, vertex.surface.triangle, vertex.to_previous, vertex.distance);
  return power_heuristic(path.bsdf_pdf, light_pdf) * vertex.surface.emission;
}

void Integrator::add_punctual(Wave& wave, size_t i, const PathVertex& vertex, const Bsdf& bsdf) const {
  const Wave::Path& path = wave.paths_[i];
  const SurfacePoint& surface = vertex.surface;
  const std::optional<PunctualSample> light =
      lights_.sample_punctual({surface.position, surface.shading_normal}, wave.choose_punctual_.x[i]);
  if (!light) return;
  const glm::vec3 radiance = bsdf.value(light->to_light) * light->irradiance;
  if (radiance == glm::vec3(0.0f)) return;
  wave.pend(path.start, path.throughput * radiance);
  Ray& ray = wave.shadow_rays_.emplace_back();
  ray.origin = surface.position + caster_.surface_offset() * surface.geometric_normal;
  ray.direction = light->to_light;
  ray.tmax = light->distance;
}

void Integrator::add_emitters(Wave& wave, size_t i, const PathVertex& vertex, const Bsdf& bsdf) const {
  const Wave::Path& path = wave.paths_[i];
  const SurfacePoint& surface = vertex.surface;
  const std::optional<EmitterSample> light =
      lights_.sample_emitter({surface.position, surface.shading_normal}, wave.point_on_emitter_.bits(i));
  if (!light) return;
  const glm::vec3 radiance = bsdf.value(light->to_light) * light->radiance;
  if (radiance == glm::vec3(0.0f)) return;
  const float weight = power_heuristic(light->pdf, bsdf.pdf(light->to_light));
  wave.pend(path.start, path.throughput * radiance * (weight / light->pdf));
  const float offset = caster_.surface_offset();
  Ray& ray = wave.shadow_rays_.emplace_back();
  ray.origin = surface.position + offset * surface.geometric_normal;
  ray.direction = light->position + offset * light->normal - ray.origin;
  ray.tmax = 1.0f;
}

/// Sends the path on to its next vertex, unless it ends here.
void Integrator::scatter(Wave& wave, size_t i, const PathVertex& vertex, const Bsdf& bsdf) const {
  const Wave::Path& path = wave.paths_[i];
  const std::optional<BsdfSample> next =
      bsdf.sample(unit_float(wave.choose_lobe_.x[i]), unit_floats(wave.bsdf_direction_.bits(i)));
  if (!next) return;
  glm::vec3 throughput = path.throughput * next->weight;
  if (!finite(throughput)) {
    ++wave.samples_[path.start].nonfinite;
    return;
  }
  // From the throughput alone, never from the light: twice the light then gives exactly twice the image.
  if (wave.depth_ > 0) {
    const float most = wave.depth_ < long_path ? 1.0f : most_survival_of_long;
    const float survival = std::min(largest(throughput) / least_throughput, most);
    if (survival < 1.0f) {
      if (unit_float(wave.roulette_.x[i]) >= survival) return;
      throughput /= survival;
    }
  }
  Wave::Path& onwards = wave.next_paths_.emplace_back();
  onwards.start = path.start;
  onwards.throughput = throughput;
  onwards.bsdf_pdf = next->pdf;
  onwards.previous = {vertex.surface.position, vertex.surface.shading_normal};
  Ray& ray = wave.next_rays_.emplace_back();
  ray.origin = vertex.surface.position + caster_.surface_offset() * vertex.surface.geometric_normal;
  ray.direction = next->in;
}

}  // namespace voxref
