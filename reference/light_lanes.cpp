// Light sampling at many vertices.
#include "reference/light_sampling.h"
#include "reference/sampler.h"
#include "reference/vertices.h"
#include "reference/warp.h"
#include "scene/light_inline.h"

namespace voxref {

namespace {

/// A single point or spot light.
VOXREF_WIDEST void illuminate_all(const Light& light, size_t count, const Lanes3& positions, LightLanes& found) {
  const auto illuminate = [&](bool spot) {
    VOXREF_INDEPENDENT
    for (size_t i = 0; i < count; ++i) {
      const Illumination here = illuminate_near(light, spot, positions[i]);
      found.to_light.set(i, here.to_light);
      found.distance[i] = here.distance;
      found.light.set(i, here.irradiance);
    }
  };
  light.type == LightType::spot ? illuminate(true) : illuminate(false);
}

}  // namespace

void LightSampler::sample_punctual(const Vertices& vertices, const uint32_t* bits, LightLanes& found) const {
  if (scene_.lights.size() == 1 && scene_.lights[0].type != LightType::directional)
    return illuminate_all(scene_.lights[0], vertices.size(), vertices.positions(), found);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const std::optional<PunctualSample> sample = sample_punctual(vertices.receiver(i), bits[i]);
    found.light.set(i, sample ? sample->irradiance : glm::vec3(0.0f));
    found.to_light.set(i, sample ? sample->to_light : glm::vec3(0.0f));
    if (!sample) continue;
    found.distance[i] = sample->distance;
  }
}

/// Emitter by emitter: each loop takes those lanes that have chosen it.
VOXREF_WIDEST void LightSampler::sample_few_emitters(const Vertices& vertices, const uint32_t* x, const uint32_t* y,
                                                     LightLanes& found) const {
  const LightTable table = emitter_table_;
  const Lanes3& positions = vertices.positions();
  const size_t count = vertices.size();
  const auto sample_one = [&](uint32_t index, bool first) {
    const Emitter emitter = emitters_[index];
    VOXREF_INDEPENDENT
    for (size_t i = 0; i < count; ++i) {
      const LightChoice choice = table.choose(x[i]);
      const glm::vec2 uv = uniform_triangle({choice.rest, unit_float(y[i])});
      const EmitterSample sample = sample_point(emitter, choice.probability, uv, positions[i]);
      const bool chosen = first | (choice.index == index);
      found.to_light.set(i, select(chosen, sample.to_light, found.to_light[i]));
      found.position.set(i, select(chosen, sample.position, found.position[i]));
      found.normal.set(i, select(chosen, sample.normal, found.normal[i]));
      found.light.set(i, select(chosen, sample.radiance, found.light[i]));
      found.pdf[i] = chosen ? sample.pdf : found.pdf[i];
    }
  };
  sample_one(0, true);
  for (uint32_t index = 1; index < emitters_.size(); ++index) sample_one(index, false);
}

void LightSampler::sample_emitter(const Vertices& vertices, const uint32_t* x, const uint32_t* y,
                                  LightLanes& found) const {
  if (few_emitters() && !emission_varies_) return sample_few_emitters(vertices, x, y, found);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const std::optional<EmitterSample> sample = sample_emitter(vertices.receiver(i), {x[i], y[i]});
    found.light.set(i, sample ? sample->radiance : glm::vec3(0.0f));
    found.to_light.set(i, sample ? sample->to_light : glm::vec3(0.0f));
    if (!sample) continue;
    found.position.set(i, sample->position);
    found.normal.set(i, sample->normal);
    found.pdf[i] = sample->pdf;
  }
}

}  // namespace voxref
