#pragma once
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "reference/lanes.h"
#include "reference/light_tree.h"
#include "scene/scene.h"
#include "scene/surface.h"

namespace voxref {

/// A punctual light chosen at random, seen from a point, shadows left out.
struct PunctualSample {
  glm::vec3 to_light{0.0f};    ///< unit
  float distance = 0.0f;       ///< world units; infinity for a directional light
  glm::vec3 irradiance{0.0f};  ///< on a surface that faces the light, over the probability of the choice, W/m^2
};

/// A point of an emissive triangle chosen at random, seen from a point, shadows left out.
struct EmitterSample {
  glm::vec3 to_light{0.0f};  ///< unit
  glm::vec3 position{0.0f};  ///< on the light
  glm::vec3 normal{0.0f};    ///< of the light, unit, towards the receiver
  glm::vec3 radiance{0.0f};  ///< W/(sr m^2)
  float pdf = 0.0f;          ///< per solid angle at the receiver
};

class Vertices;

/// What is sampled at each of many vertices: the members of PunctualSample or EmitterSample. Where there is nothing,
/// `light` is zero, `to_light` without length or right, and the rest undefined.
struct LightLanes {
  Lanes3 to_light;
  Lanes3 light;             // irradiance of a punctual light, radiance of an emissive triangle
  Lanes<float> distance;    // of a punctual light
  Lanes3 position, normal;  // on an emissive triangle
  Lanes<float> pdf;         // of that position
};

/// Chooses among a scene's lights. Keeps references to the scene and its materials.
///
/// Punctual lights: where there are few, in proportion to the irradiance that each gives at the receiver; else
/// directional ones so, and the others by a light tree. Emissive triangles: by intensity, area x mean radiance, where
/// there are few, else by a light tree; then uniformly over the area.
class LightSampler {
 public:
  LightSampler(const Scene& scene, const Materials& materials);

  size_t punctual_count() const { return scene_.lights.size(); }
  bool has_emitters() const { return !emitters_.empty(); }

  /// @param bits uniform over all 32-bit numbers; not used with a single light
  std::optional<PunctualSample> sample_punctual(const Receiver& receiver, uint32_t bits) const;
  /// @param bits two uniform 32-bit numbers; the first chooses the triangle and, with what is left of it, the point
  std::optional<EmitterSample> sample_emitter(const Receiver& receiver, const glm::uvec2& bits) const;
  /// The same at many vertices; of the random bits there are as many.
  void sample_punctual(const Vertices& vertices, const uint32_t* bits, LightLanes& found) const;
  void sample_emitter(const Vertices& vertices, const uint32_t* x, const uint32_t* y, LightLanes& found) const;
  /// Density with which sample_emitter draws a point of `triangle`, per solid angle at a receiver from which the point
  /// is seen along the unit `direction` at `distance`; 0 for a triangle that is never drawn there.
  float emitter_pdf(const Receiver& receiver, uint32_t triangle, const glm::vec3& direction, float distance) const;

 private:
  struct Emitter {
    glm::vec3 origin{0.0f}, edge_u{0.0f}, edge_v{0.0f};
    glm::vec3 normal{0.0f};    // unit, of the counter-clockwise side
    glm::vec3 emission{0.0f};  // where it is the same everywhere
    float area = 0.0f;
    uint32_t triangle = 0;
    bool varies = false, double_sided = false;
  };
  /// What is seen from a point, as if emission were the same everywhere. Without branches, see lanes.h.
  static EmitterSample sample_point(const Emitter& emitter, float probability, const glm::vec2& uv,
                                    const glm::vec3& from);
  void sample_few_emitters(const Vertices& vertices, const uint32_t* x, const uint32_t* y, LightLanes& found) const;
  bool few_emitters() const { return emitters_.size() <= LightTable::most_lights; }
  void add_emitters();
  void add_punctual();
  std::optional<PunctualSample> sample_few(const Receiver& receiver, uint32_t bits) const;
  std::optional<PunctualSample> sample_many(const Receiver& receiver, uint32_t bits) const;

  const Scene& scene_;
  const Materials& materials_;
  std::vector<uint32_t> directional_;  // where there are many lights: those that are not in the tree
  LightTree punctual_tree_;
  std::vector<Emitter> emitters_;
  bool emission_varies_ = false;               // on some emitter
  LightTable emitter_table_;                   // of the same indices, where they are few
  LightTree emitter_tree_;                     // where they are many
  std::vector<uint32_t> emitter_of_triangle_;  // empty without emitters; Hit::none for a triangle that is none
};

inline EmitterSample LightSampler::sample_point(const Emitter& emitter, float probability, const glm::vec2& uv,
                                                const glm::vec3& from) {
  const glm::vec3 position = emitter.origin + uv.x * emitter.edge_u + uv.y * emitter.edge_v;
  const glm::vec3 offset = position - from;
  const float distance = glm::length(offset);
  const glm::vec3 to_light = offset / distance;
  const float cosine = -glm::dot(emitter.normal, to_light);
  const float side = cosine > 0.0f ? 1.0f : -1.0f;
  const bool lit = (cosine > 0.0f) | (emitter.double_sided & (cosine < 0.0f));
  return {{to_light.x, to_light.y, to_light.z},
          {position.x, position.y, position.z},
          {side * emitter.normal.x, side * emitter.normal.y, side * emitter.normal.z},
          {lit ? emitter.emission.x : 0.0f, lit ? emitter.emission.y : 0.0f, lit ? emitter.emission.z : 0.0f},
          probability * distance * distance / (emitter.area * std::abs(cosine))};
}

}  // namespace voxref
