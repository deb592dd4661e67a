#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace voxref {

/// Where light arrives.
struct Receiver {
  glm::vec3 position{0.0f};  ///< world
  glm::vec3 normal{0.0f};    ///< unit; light from behind it counts as none
};

/// What is known of a light, or of a group of lights, without looking at each: where they are, and that none sends
/// light further than `spread` + `reach` away from `axis`.
struct LightBounds {
  Bounds box;              ///< world
  glm::vec3 axis{0.0f};    ///< unit
  float spread = 0.0f;     ///< most angle between the axis and a light's own axis, radians, 0 to pi
  float reach = 0.0f;      ///< most angle between a light's own axis and a direction in which it sends light, 0 to pi/2
  float intensity = 0.0f;  ///< along the own axis, luminance: W/sr; summed over a group
};

struct LightChoice {
  uint32_t index = 0;
  float probability = 0.0f;  ///< of this index, in (0,1]
  float rest = 0.0f;         ///< what chose is uniform again within its choice, and so serves once more: in [0,1)
};

/// Chooses among a few lights by intensity alone: there, estimates cost more time than they save noise. Most often
/// these are the two halves of a rectangle. Without branches, see lanes.h.
class LightTable {
 public:
  static constexpr size_t most_lights = 4;

  LightTable() = default;
  /// @param intensities at most most_lights, each above 0
  explicit LightTable(std::span<const float> intensities);

  /// @param bits uniform 32-bit number
  LightChoice choose(uint32_t bits) const {
    const uint32_t u = std::min(bits, nowhere - 1);
    uint32_t index = 0, begin = 0;
    float probability = probability_[0];
    for (uint32_t light = 1; light < most_lights; ++light) {
      const bool beyond = u >= begin_[light];
      index = beyond ? light : index;
      begin = beyond ? begin_[light] : begin;
      probability = beyond ? probability_[light] : probability;
    }
    // Halved, the distance fits a signed number, which alone is converted in one instruction.
    const float beyond_begin = static_cast<float>(static_cast<int32_t>((u - begin) >> 1)) * 0x1p-31f;
    return {index, probability, std::min(beyond_begin / probability, 0x1.fffffep-1f)};
  }
  float probability(uint32_t light) const { return probability_[light]; }

 private:
  static constexpr uint32_t nowhere = 0xffffffff;  // begin of lights that there are not
  // Each light has the numbers from its begin up to the next one's, and at least one. Its probability is
  // their share, so that what is said is what is drawn, however faint the light.
  std::array<uint32_t, most_lights> begin_{};
  std::array<float, most_lights> probability_{};
};

/// Chooses among many lights about in proportion to what each would give a receiver, shadows left out: a binary tree
/// of groups, walked down by estimates from their bounds. After Conty Estevez and Kulla 2018, "Importance Sampling of
/// Many Lights with Adaptive Tree Splitting", without the splitting: one light each time.
///
/// Against a choice by power alone, path traced rooms: 20,000 small emissive triangles, a third of the variance at 1.9
/// times the time; 300 point lights, a tenth of the variance at 1.3 times the time.
///
/// A light that gives a receiver anything is chosen with a probability above 0.
class LightTree {
 public:
  LightTree() = default;
  /// @param lights of finite intensity; those of none are never chosen
  explicit LightTree(std::span<const LightBounds> lights);

  /// Nothing where it is certain that no light reaches the receiver. @param u uniform in [0,1)
  std::optional<LightChoice> choose(const Receiver& receiver, double u) const;
  /// Probability with which choose() finds a light.
  float probability(uint32_t light, const Receiver& receiver) const;
  /// Estimate of the irradiance that all lights together give, W/m^2 of luminance.
  float irradiance(const Receiver& receiver) const;

 private:
  /// Of a group, as irradiance() needs it.
  struct Node {
    glm::vec3 center{0.0f};
    float radius_squared = 0.0f;  // of the sphere around the box
    glm::vec3 axis{0.0f};
    float cos_spread = 0.0f, sin_spread = 0.0f, cos_reach = 0.0f;
    float intensity = 0.0f;
    uint32_t next = 0;  // of a leaf the light, else the second child; the first stands behind its parent
    bool leaf = false;
  };
  struct Builder;
  static float irradiance(const Node& node, const Receiver& receiver);
  /// Probability of the first child; below 0 where neither gives anything.
  float first_share(uint32_t node, const Receiver& receiver) const;

  std::vector<Node> nodes_;
  std::vector<uint64_t> trails_;  // per light: bit k is set where the way from the root turns to the second child
  std::vector<bool> chosen_;      // per light: whether it is in the tree
};

}  // namespace voxref
