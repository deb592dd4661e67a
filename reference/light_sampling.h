#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "scene/surface.h"

namespace voxref {

/// Draws an index in proportion to given weights in constant time: Walker's alias method, tables after Vose 1991.
class AliasTable {
 public:
  AliasTable() = default;
  /// @param weights finite, none negative; all zero: uniform
  explicit AliasTable(std::span<const double> weights);

  /// What chose the index is uniform again within its choice, and so serves once more.
  struct Choice {
    uint32_t index = 0;
    float rest = 0.0f;  ///< in [0,1)
  };
  /// @param bits uniform over all 32-bit numbers; the table must not be empty
  Choice choose(uint32_t bits) const;
  /// Probability of an index, in [0,1].
  float probability(uint32_t index) const { return entries_[index].probability; }

 private:
  struct Entry {
    uint64_t threshold;  // of 2^32: below it the entry itself, else its alias
    uint32_t alias;
    float probability;
  };
  std::vector<Entry> entries_;
};

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
/// Punctual lights: where there are few, in proportion to the irradiance that each would give at the point; else in
/// proportion to the power that they send into the scene. Emissive triangles: in proportion to area x luminance of
/// their mean emission, then uniformly over the area.
class LightSampler {
 public:
  LightSampler(const Scene& scene, const Materials& materials);

  size_t punctual_count() const { return scene_.lights.size(); }
  bool has_emitters() const { return !emitters_.empty(); }

  /// @param normal unit, of the receiving surface; light from behind it counts as none
  /// @param bits uniform over all 32-bit numbers; not used with a single light
  std::optional<PunctualSample> sample_punctual(const glm::vec3& point, const glm::vec3& normal, uint32_t bits) const;
  /// @param bits two uniform 32-bit numbers; the first chooses the triangle and, with what is left of it, the point
  std::optional<EmitterSample> sample_emitter(const glm::vec3& point, const glm::uvec2& bits) const;
  /// Density with which sample_emitter draws a point of `triangle`, per solid angle at a receiver from which the point
  /// is seen along the unit `direction` at `distance`; 0 for a triangle that is never drawn.
  float emitter_pdf(uint32_t triangle, const glm::vec3& direction, float distance) const;

 private:
  struct Emitter {
    glm::vec3 origin{0.0f}, edge_u{0.0f}, edge_v{0.0f};
    glm::vec3 normal{0.0f};    // unit, of the counter-clockwise side
    glm::vec3 emission{0.0f};  // where it is the same everywhere
    float area_pdf = 0.0f;     // per area: probability of the triangle / its area
    uint32_t triangle = 0;
    bool varies = false, double_sided = false;
  };
  void add_emitters();
  void add_punctual();

  const Scene& scene_;
  const Materials& materials_;
  AliasTable punctual_;
  std::vector<Emitter> emitters_;
  AliasTable emitter_table_;
  std::vector<uint32_t> emitter_of_triangle_;  // empty without emitters; Hit::none for a triangle that is none
};

}  // namespace voxref
