#include "reference/integrator.h"

#include <algorithm>
#include <cassert>
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
// path would never end; from the 33rd surface on every one loses at least 2 %.
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
  assert(starts.size() <= most_paths);
  starts_ = starts;
  depth_ = 0;
  samples_.assign(starts.size(), {});
  bounces_each_ = bounces_each;
  bounces_.assign(starts.size() * bounces_each, glm::vec3(0.0f));
  vertices_.clear();
}

/// All random numbers of the vertices, whether they come to be needed or not: made together, they cost little.
void Wave::draw() {
  samplers_.clear();
  for (size_t i = 0; i < vertices_.size(); ++i) samplers_.add(starts_[start_[i]].sampler);
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

/// Its light reaches the camera if nothing blocks the ray.
void Wave::pend(size_t vertex, const Ray& shadow_ray) {
  pending_[pending_count_] = {start_[vertex], radiance_[vertex]};
  shadow_rays_[pending_count_] = shadow_ray;
  ++pending_count_;
}

/// What the sampled lights bring, shadows left out. @param against_bsdf the BSDF's samples may find the same light
VOXREF_WIDEST void Wave::weigh_by_light(bool against_bsdf) {
  const auto weigh = [&](bool weighs) {
    const size_t count = vertices_.size();
    VOXREF_INDEPENDENT
    for (size_t i = 0; i < count; ++i) {
      const float weight = weighs ? power_heuristic(light_.pdf[i], pdf_[i]) / light_.pdf[i] : 1.0f;
      const glm::vec3 arriving = scattered_[i] * light_.light[i];
      const bool some = (arriving.x != 0.0f) | (arriving.y != 0.0f) | (arriving.z != 0.0f);
      radiance_.set(i, select(some, throughput_[i] * arriving * weight, glm::vec3(0.0f)));
    }
  };
  against_bsdf ? weigh(true) : weigh(false);
}

/// Throughput beyond the vertices, after roulette. From the throughput alone, never from the light: twice the light
/// then gives exactly twice the image.
VOXREF_WIDEST void Wave::weigh_by_bsdf(float least_survival, float most_survival) {
  const size_t count = vertices_.size();
  const uint32_t* numbers = roulette_.x.data();
  VOXREF_INDEPENDENT
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 weight = weight_[i];
    const glm::vec3 throughput = throughput_[i] * weight;
    const float kept = largest(throughput) / least_throughput;
    const float survival = std::min(std::max(kept, least_survival), most_survival);
    const bool some = (weight.x != 0.0f) | (weight.y != 0.0f) | (weight.z != 0.0f);
    goes_on_[i] = (some & !(unit_float(numbers[i]) >= survival)) ? 1u : 0u;
    throughput_.set(i, throughput / survival);
  }
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
  Wave::Path path;
  for (path.start = 0; path.start < starts.size(); ++path.start) {
    if (starts[path.start].seen)
      arrive(wave, path, *starts[path.start].seen);
    else
      wave.add(path.start, 0, background_);
  }
  scatter(wave, counts);
  while (wave.path_count_ > 0) {
    follow(wave, counts);
    scatter(wave, counts);
  }
  for (const PathSample& sample : wave.samples_) counts.nonfinite += sample.nonfinite;
}

/// Casts the rays of all paths that go on, and takes them to the surfaces that these find.
void Integrator::follow(Wave& wave, PathCounts& counts) const {
  ++wave.depth_;
  wave.vertices_.clear();
  const std::span<Hit> hits = std::span(wave.hits_).first(wave.path_count_);
  caster_.closest(std::span(wave.rays_).first(wave.path_count_), hits);
  counts.closest_rays += wave.path_count_;
  surfaces_.prefetch(hits);
  for (size_t i = 0; i < wave.path_count_; ++i) {
    const Wave::Path& path = wave.paths_[i];
    if (wave.hits_[i])
      arrive(wave, path, PathVertex(surfaces_, wave.hits_[i], wave.rays_[i]));
    else
      wave.add(path.start, wave.depth_, path.throughput * background_);
  }
}

void Integrator::arrive(Wave& wave, const Wave::Path& path, const PathVertex& vertex) const {
  const SurfacePoint& surface = vertex.surface;
  if (surface.emission != glm::vec3(0.0f)) wave.add(path.start, wave.depth_, path.throughput * emitted(path, vertex));
  if (wave.depth_ >= max_depth_ || surface.reflectance.black()) return;
  const size_t i = wave.vertices_.size();
  wave.start_[i] = path.start;
  wave.throughput_.set(i, path.throughput);
  if (!compensates_) return wave.vertices_.add(surface, vertex.to_previous);
  SurfacePoint compensated = surface;
  compensate_energy(compensated.reflectance, glm::dot(surface.shading_normal, vertex.to_previous));
  wave.vertices_.add(compensated, vertex.to_previous);
}

/// Emission of the vertex, weighed against the chance that the vertex before had sampled it as a light.
glm::vec3 Integrator::emitted(const Wave::Path& path, const PathVertex& vertex) const {
  if (path.bsdf_pdf == 0.0f) return vertex.surface.emission;
  const float light_pdf =
      lights_.emitter_pdf(path.previous, vertex.surface.triangle, vertex.to_previous, vertex.distance);
  return power_heuristic(path.bsdf_pdf, light_pdf) * vertex.surface.emission;
}

/// Light that the vertices scatter: straight from the lights, and what the paths go on to find.
void Integrator::scatter(Wave& wave, PathCounts& counts) const {
  wave.draw();
  if (lights_.punctual_count() > 0) {
    add_punctual(wave);
    settle_shadows(wave, counts);
  }
  if (lights_.has_emitters()) {
    add_emitters(wave);
    settle_shadows(wave, counts);
  }
  wave.path_count_ = 0;
  // The last ray can only find light itself.
  if (wave.depth_ + 1 < max_depth_ || light_can_be_hit_) go_on(wave);
}

void Integrator::add_punctual(Wave& wave) const {
  const Vertices& vertices = wave.vertices_;
  lights_.sample_punctual(vertices, wave.choose_punctual_.x.data(), wave.light_);
  vertices.evaluate(wave.light_.to_light, wave.scattered_, wave.pdf_);
  wave.weigh_by_light(false);
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (wave.radiance_[i] == glm::vec3(0.0f)) continue;
    wave.pend(i, {leave(vertices, i), wave.light_.to_light[i], 0.0f, wave.light_.distance[i]});
  }
}

void Integrator::add_emitters(Wave& wave) const {
  const Vertices& vertices = wave.vertices_;
  lights_.sample_emitter(vertices, wave.point_on_emitter_.x.data(), wave.point_on_emitter_.y.data(), wave.light_);
  vertices.evaluate(wave.light_.to_light, wave.scattered_, wave.pdf_);
  wave.weigh_by_light(true);
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (wave.radiance_[i] == glm::vec3(0.0f)) continue;
    const glm::vec3 target = wave.light_.position[i] + caster_.surface_offset() * wave.light_.normal[i];
    wave.pend(i, Caster::segment(leave(vertices, i), target));
  }
}

/// Light sampled at the vertices arrives where nothing blocks it.
void Integrator::settle_shadows(Wave& wave, PathCounts& counts) const {
  caster_.occluded(std::span(wave.shadow_rays_).first(wave.pending_count_),
                   std::span(wave.blocked_).first(wave.pending_count_));
  counts.occlusion_rays += wave.pending_count_;
  for (size_t i = 0; i < wave.pending_count_; ++i)
    if (!wave.blocked_[i]) wave.add(wave.pending_[i].start, wave.depth_ + 1, wave.pending_[i].radiance);
  wave.pending_count_ = 0;
}

/// Sends the paths on to their next vertices, unless they end here.
void Integrator::go_on(Wave& wave) const {
  const Vertices& vertices = wave.vertices_;
  vertices.sample(wave.choose_lobe_.x.data(), wave.bsdf_direction_.x.data(), wave.bsdf_direction_.y.data(), wave.next_,
                  wave.weight_, wave.pdf_);
  wave.weigh_by_bsdf(wave.depth_ == 0 ? 1.0f : 0.0f, wave.depth_ < long_path ? 1.0f : most_survival_of_long);
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (!wave.goes_on_[i]) continue;
    const glm::vec3 throughput = wave.throughput_[i];
    if (!finite(throughput)) {
      ++wave.samples_[wave.start_[i]].nonfinite;
      continue;
    }
    wave.paths_[wave.path_count_] = {wave.start_[i], throughput, wave.pdf_[i], vertices.receiver(i)};
    wave.rays_[wave.path_count_] = {leave(vertices, i), wave.next_[i]};
    ++wave.path_count_;
  }
}

/// Where a ray from the vertex begins.
glm::vec3 Integrator::leave(const Vertices& vertices, size_t i) const {
  return caster_.beside(vertices.positions()[i], vertices.geometric_normals()[i]);
}

}  // namespace voxref
