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

namespace {

// Up to here every light's irradiance at the point is computed, which costs less than a shadow ray that finds nothing.
constexpr size_t few_lights = 4;

// Mean emission over a textured triangle from the centres of this many parts along each edge. It only steers sampling.
constexpr int emission_parts = 4;

LightBounds bounds_of(const Light& light) {
  constexpr float pi = std::numbers::pi_v<float>;
  LightBounds bounds;
  if (light.type == LightType::directional) return bounds;  // of no intensity: it is nowhere
  bounds.box.add(light.position);
  bounds.axis = light.direction;
  bounds.spread = light.type == LightType::point ? pi : 0.0f;
  bounds.reach = light.type == LightType::point ? 0.5f * pi : std::acos(std::clamp(light.cos_outer, 0.0f, 1.0f));
  bounds.intensity = luminance(light.intensity);
  return bounds;
}

/// Luminance of the irradiance on the receiver.
float weigh(const Illumination& light, const Receiver& receiver) {
  return luminance(light.irradiance) * std::max(glm::dot(receiver.normal, light.to_light), 0.0f);
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
  if (scene_.lights.size() <= few_lights) return;
  std::vector<LightBounds> bounds;
  for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
    bounds.push_back(bounds_of(scene_.lights[i]));
    if (scene_.lights[i].type == LightType::directional) directional_.push_back(i);
  }
  punctual_tree_ = LightTree(bounds);
}

void LightSampler::add_emitters() {
  constexpr float pi = std::numbers::pi_v<float>;
  std::vector<LightBounds> bounds;
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
    emitter.area = 0.5f * twice_area;
    const float intensity = emitter.area * luminance(emitter.emission);
    // What is never drawn is still found by the BSDF's rays, which then count in full.
    if (!(intensity > 0.0f)) continue;
    emitter.normal = normal / twice_area;
    emission_varies_ = emission_varies_ || emitter.varies;
    emitters_.push_back(emitter);
    Bounds box;
    for (int corner = 0; corner < 3; ++corner) box.add(scene_.positions[corners[corner]]);
    bounds.push_back({box, emitter.normal, emitter.double_sided ? pi : 0.0f, 0.5f * pi, intensity});
  }
  if (emitters_.empty()) return;
  if (few_emitters()) {
    std::vector<float> intensities;
    intensities.reserve(bounds.size());
    for (const LightBounds& emitter : bounds) intensities.push_back(emitter.intensity);
    emitter_table_ = LightTable(intensities);
  } else {
    emitter_tree_ = LightTree(bounds);
  }
  emitter_of_triangle_.assign(scene_.triangles.size(), Hit::none);
  for (uint32_t i = 0; i < emitters_.size(); ++i) emitter_of_triangle_[emitters_[i].triangle] = i;
}

std::optional<PunctualSample> LightSampler::sample_punctual(const Receiver& receiver, uint32_t bits) const {
  const size_t count = scene_.lights.size();
  if (count > few_lights) return sample_many(receiver, bits);
  if (count > 1) return sample_few(receiver, bits);
  const Illumination light = illuminate(scene_.lights[0], receiver.position);
  if (glm::dot(receiver.normal, light.to_light) <= 0.0f) return std::nullopt;
  std::optional<PunctualSample> sample(std::in_place);
  sample->to_light = light.to_light;
  sample->distance = light.distance;
  sample->irradiance = light.irradiance;
  return sample;
}

std::optional<PunctualSample> LightSampler::sample_few(const Receiver& receiver, uint32_t bits) const {
  const size_t count = scene_.lights.size();
  std::array<Illumination, few_lights> lights;
  std::array<float, few_lights> weights{};
  float total = 0.0f;
  for (size_t i = 0; i < count; ++i) {
    lights[i] = illuminate(scene_.lights[i], receiver.position);
    weights[i] = weigh(lights[i], receiver);
    total += weights[i];
  }
  if (total == 0.0f) return std::nullopt;  // a NaN goes on, to be counted
  size_t chosen = 0;
  for (double left = bits * 0x1p-32 * total; chosen + 1 < count; ++chosen) {
    left -= weights[chosen];
    if (left < 0.0) break;
  }
  while (chosen > 0 && weights[chosen] == 0.0f) --chosen;  // rounding ran past the last light that gives something
  const Illumination& light = lights[chosen];
  return PunctualSample{light.to_light, light.distance, light.irradiance * (total / weights[chosen])};
}

std::optional<PunctualSample> LightSampler::sample_many(const Receiver& receiver, uint32_t bits) const {
  const float in_tree = punctual_tree_.irradiance(receiver);
  float total = in_tree;
  for (const uint32_t i : directional_) total += weigh(illuminate(scene_.lights[i], receiver.position), receiver);
  double left = bits * 0x1p-32 * total;
  for (const uint32_t i : directional_) {
    const Illumination light = illuminate(scene_.lights[i], receiver.position);
    const float weight = weigh(light, receiver);
    if (left < weight) return PunctualSample{light.to_light, light.distance, light.irradiance * (total / weight)};
    left -= weight;
  }
  if (!(in_tree > 0.0f)) return std::nullopt;
  constexpr double below_one = 1.0 - 0x1p-53;
  const auto choice = punctual_tree_.choose(receiver, std::min(left / in_tree, below_one));
  if (!choice) return std::nullopt;
  const Illumination light = illuminate(scene_.lights[choice->index], receiver.position);
  return PunctualSample{light.to_light, light.distance, light.irradiance * (total / (in_tree * choice->probability))};
}

std::optional<EmitterSample> LightSampler::sample_emitter(const Receiver& receiver, const glm::uvec2& bits) const {
  const std::optional<LightChoice> choice =
      few_emitters() ? emitter_table_.choose(bits.x) : emitter_tree_.choose(receiver, bits.x * 0x1p-32);
  if (!choice) return std::nullopt;
  const Emitter& emitter = emitters_[choice->index];
  const glm::vec2 uv = uniform_triangle({choice->rest, unit_float(bits.y)});
  EmitterSample sample = sample_point(emitter, choice->probability, uv, receiver.position);
  if (sample.radiance == glm::vec3(0.0f)) return std::nullopt;
  if (emitter.varies) {
    const MaterialPoint material = materials_.point(emitter.triangle, uv);
    sample.radiance = material.opacity * material.emission;
  }
  return sample;
}

float LightSampler::emitter_pdf(const Receiver& receiver, uint32_t triangle, const glm::vec3& direction,
                                float distance) const {
  if (emitter_of_triangle_.empty() || emitter_of_triangle_[triangle] == Hit::none) return 0.0f;
  const uint32_t index = emitter_of_triangle_[triangle];
  const Emitter& emitter = emitters_[index];
  const float cosine = std::abs(glm::dot(emitter.normal, direction));
  if (!(cosine > 0.0f)) return 0.0f;
  const float probability =
      few_emitters() ? emitter_table_.probability(index) : emitter_tree_.probability(index, receiver);
  return probability * distance * distance / (emitter.area * cosine);
}

}  // namespace voxref
