#include "reference/light_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "image/image.h"
#include "reference/sampler.h"
#include "reference/warp.h"
#include "scene/ray.h"

namespace voxref {

AliasTable::AliasTable(std::span<const double> weights) {
  const size_t count = weights.size();
  double total = 0.0;
  for (const double weight : weights) total += weight;

  // Vose: entries below the mean share their slot with one above it.
  std::vector<double> scaled(count, 1.0);
  std::vector<uint32_t> small, large;
  entries_.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    if (total > 0.0) scaled[i] = weights[i] / total * static_cast<double>(count);
    entries_[i] = {uint64_t{1} << 32, i, static_cast<float>(scaled[i] / static_cast<double>(count))};
    (scaled[i] < 1.0 ? small : large).push_back(i);
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t below = small.back(), above = large.back();
    small.pop_back();
    entries_[below].threshold = static_cast<uint64_t>(scaled[below] * 0x1p32);
    entries_[below].alias = above;
    scaled[above] -= 1.0 - scaled[below];
    if (scaled[above] >= 1.0) continue;
    large.pop_back();
    small.push_back(above);
  }
}

AliasTable::Choice AliasTable::choose(uint32_t bits) const {
  const uint64_t product = uint64_t{bits} * entries_.size();  // the slot in the upper half, a fraction in the lower
  const auto slot = static_cast<uint32_t>(product >> 32);
  const uint64_t fraction = product & 0xffffffffu;
  const uint64_t threshold = entries_[slot].threshold;
  const bool own = fraction < threshold;
  const uint64_t place = own ? fraction : fraction - threshold;
  const uint64_t width = own ? threshold : (uint64_t{1} << 32) - threshold;
  // Rounding of the two may reach 1, which the largest float below it stands in for.
  const float rest = std::min(static_cast<float>(place) / static_cast<float>(width), 0x1.fffffep-1f);
  return {own ? slot : entries_[slot].alias, rest};
}

namespace {

// Up to here every light's irradiance at the point is computed, which costs less than a shadow ray that finds nothing.
constexpr size_t few_lights = 4;

// Mean emission over a textured triangle from the centres of this many parts along each edge. It only steers sampling.
constexpr int emission_parts = 4;

double power(const Light& light, double scene_radius) {
  const double intensity = luminance(light.intensity);
  constexpr double pi = std::numbers::pi;
  switch (light.type) {
    case LightType::point:
      return 4.0 * pi * intensity;
    case LightType::spot:
      return 2.0 * pi * (1.0 - light.cos_outer) * intensity;
    case LightType::directional:
      return pi * scene_radius * scene_radius * intensity;
  }
  return 0.0;
}

glm::vec3 mean_emission(const Materials& materials, uint32_t triangle) {
  glm::vec3 sum(0.0f);
  int count = 0;
  for (int i = 0; i < emission_parts; ++i)
    for (int j = 0; j + i < emission_parts; ++j, ++count) {
      const glm::vec2 uv = (glm::vec2(i, j) + 1.0f / 3.0f) / static_cast<float>(emission_parts);
      const MaterialPoint point = materials.point(triangle, uv);
      sum += point.opacity * point.emission;
    }
  return sum / static_cast<float>(count);
}

}  // namespace

LightSampler::LightSampler(const Scene& scene, const Materials& materials) : scene_(scene), materials_(materials) {
  add_punctual();
  add_emitters();
}

void LightSampler::add_punctual() {
  const double radius = 0.5 * glm::length(scene_.bounds().extent());
  std::vector<double> weights;
  for (const Light& light : scene_.lights) weights.push_back(power(light, radius));
  punctual_ = AliasTable(weights);
}

void LightSampler::add_emitters() {
  std::vector<double> weights;
  for (uint32_t triangle = 0; triangle < scene_.triangles.size(); ++triangle) {
    const Material& material = scene_.materials[scene_.triangle_materials[triangle]];
    if (!material.emissive()) continue;
    const glm::uvec3 corners = scene_.triangles[triangle];
    Emitter emitter;
    emitter.triangle = triangle;
    emitter.origin = scene_.positions[corners.x];
    emitter.edge_u = scene_.positions[corners.y] - emitter.origin;
    emitter.edge_v = scene_.positions[corners.z] - emitter.origin;
    const glm::vec3 normal = glm::cross(emitter.edge_u, emitter.edge_v);
    const float twice_area = glm::length(normal);
    emitter.varies = material.emission_texture || material.alpha_mode == AlphaMode::mask;
    emitter.emission = emitter.varies ? mean_emission(materials_, triangle) : material.emission;
    emitter.double_sided = material.double_sided;
    const double weight = 0.5 * twice_area * luminance(emitter.emission) * (emitter.double_sided ? 2.0 : 1.0);
    // What is never drawn is still found by the BSDF's rays, which then count in full.
    if (!(weight > 0.0)) continue;
    emitter.normal = normal / twice_area;
    emitters_.push_back(emitter);
    weights.push_back(weight);
  }
  if (emitters_.empty()) return;
  emitter_table_ = AliasTable(weights);
  emitter_of_triangle_.assign(scene_.triangles.size(), Hit::none);
  for (uint32_t i = 0; i < emitters_.size(); ++i) {
    Emitter& emitter = emitters_[i];
    const float area = 0.5f * glm::length(glm::cross(emitter.edge_u, emitter.edge_v));
    emitter.area_pdf = emitter_table_.probability(i) / area;
    emitter_of_triangle_[emitter.triangle] = i;
  }
}

std::optional<PunctualSample> LightSampler::sample_punctual(const glm::vec3& point, const glm::vec3& normal,
                                                            uint32_t bits) const {
  const size_t count = scene_.lights.size();
  if (count > few_lights) {
    const uint32_t chosen = punctual_.choose(bits).index;
    const Illumination light = illuminate(scene_.lights[chosen], point);
    return PunctualSample{light.to_light, light.distance, light.irradiance / punctual_.probability(chosen)};
  }
  if (count == 1) {
    const Illumination light = illuminate(scene_.lights[0], point);
    if (glm::dot(normal, light.to_light) <= 0.0f) return std::nullopt;
    std::optional<PunctualSample> sample(std::in_place);
    sample->to_light = light.to_light;
    sample->distance = light.distance;
    sample->irradiance = light.irradiance;
    return sample;
  }
  std::array<Illumination, few_lights> lights;
  std::array<float, few_lights> weights{};
  float total = 0.0f;
  for (size_t i = 0; i < count; ++i) {
    lights[i] = illuminate(scene_.lights[i], point);
    weights[i] = luminance(lights[i].irradiance) * std::max(glm::dot(normal, lights[i].to_light), 0.0f);
    total += weights[i];
  }
  if (total == 0.0f) return std::nullopt;  // a NaN goes on, to be counted
  size_t chosen = 0;
  for (float left = unit_float(bits) * total; chosen + 1 < count; ++chosen) {
    left -= weights[chosen];
    if (left < 0.0f) break;
  }
  while (chosen > 0 && weights[chosen] == 0.0f) --chosen;  // rounding ran past the last light that gives something
  const Illumination& light = lights[chosen];
  return PunctualSample{light.to_light, light.distance, light.irradiance * (total / weights[chosen])};
}

std::optional<EmitterSample> LightSampler::sample_emitter(const glm::vec3& point, const glm::uvec2& bits) const {
  const AliasTable::Choice choice = emitter_table_.choose(bits.x);
  const Emitter& emitter = emitters_[choice.index];
  const glm::vec2 uv = uniform_triangle({choice.rest, unit_float(bits.y)});
  EmitterSample sample;
  sample.position = emitter.origin + uv.x * emitter.edge_u + uv.y * emitter.edge_v;
  const glm::vec3 offset = sample.position - point;
  const float distance = glm::length(offset);
  sample.to_light = offset / distance;
  const float cosine = -glm::dot(emitter.normal, sample.to_light);
  if (!(cosine > 0.0f || (emitter.double_sided && cosine < 0.0f))) return std::nullopt;
  sample.normal = cosine > 0.0f ? emitter.normal : -emitter.normal;
  sample.pdf = emitter.area_pdf * distance * distance / std::abs(cosine);
  sample.radiance = emitter.emission;
  if (emitter.varies) {
    const MaterialPoint material = materials_.point(emitter.triangle, uv);
    sample.radiance = material.opacity * material.emission;
  }
  return sample;
}

float LightSampler::emitter_pdf(uint32_t triangle, const glm::vec3& direction, float distance) const {
  if (emitter_of_triangle_.empty() || emitter_of_triangle_[triangle] == Hit::none) return 0.0f;
  const Emitter& emitter = emitters_[emitter_of_triangle_[triangle]];
  const float cosine = std::abs(glm::dot(emitter.normal, direction));
  return cosine > 0.0f ? emitter.area_pdf * distance * distance / cosine : 0.0f;
}

}  // namespace voxref
