#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

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

/// Chooses among a scene's lights. Keeps references to the scene and its materials.
///
/// Punctual lights: where there are few, in proportion to the irradiance that each gives at the receiver; else
/// directional ones so, and the others by a light tree. Emissive triangles: by a light tree, in which area x mean
/// radiance is a triangle's intensity; then uniformly over the area.
class LightSampler {
 public:
  LightSampler(const Scene& scene, const Materials& materials);

  size_t punctual_count() const { return scene_.lights.size(); }
  bool has_emitters() const { return !emitters_.empty(); }

  /// @param bits uniform over all 32-bit numbers; not used with a single light
  std::optional<PunctualSample> sample_punctual(const Receiver& receiver, uint32_t bits) const;
  /// @param bits two uniform 32-bit numbers; the first chooses the triangle and, with what is left of it, the point
  std::optional<EmitterSample> sample_emitter(const Receiver& receiver, const glm::uvec2& bits) const;
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
  void add_emitters();
  void add_punctual();
  std::optional<PunctualSample> sample_few(const Receiver& receiver, uint32_t bits) const;
  std::optional<PunctualSample> sample_many(const Receiver& receiver, uint32_t bits) const;

  const Scene& scene_;
  const Materials& materials_;
  std::vector<uint32_t> directional_;  // where there are many lights: those that are not in the tree
  LightTree punctual_tree_;
  std::vector<Emitter> emitters_;
  LightTree emitter_tree_;                     // the same indices
  std::vector<uint32_t> emitter_of_triangle_;  // empty without emitters; Hit::none for a triangle that is none
};

}  // namespace voxref
