#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace voxref {

enum class LightType : uint8_t { point, spot, directional };

/// A punctual light (KHR_lights_punctual), mapped 1:1 to radiometry.
struct Light {
  std::string name;
  LightType type = LightType::point;
  glm::vec3 position{0.0f};                         ///< world; point and spot
  glm::vec3 direction{0.0f, 0.0f, -1.0f};           ///< unit, the way the light travels; spot and directional
  glm::vec3 intensity{1.0f};                        ///< W/sr; directional: irradiance of a facing surface, W/m^2
  float cos_inner = 1.0f, cos_outer = 0.70710678f;  ///< spot: full inside the inner cone, none outside the outer
};

enum class LightFalloff : uint8_t {
  inverse_square,  ///< as light does
  attenuated       ///< 1 / (1 + c + l d + q d^2), as the published shaders do
};

/// How point and spot lights fade with distance d (world units).
struct LightOptions {
  LightFalloff falloff = LightFalloff::inverse_square;
  glm::vec3 attenuation{0.0f};  ///< c, l (1/length), q (1/length^2) of `attenuated`; not negative
};

/// What a light does at a point, shadows left out.
struct Illumination {
  glm::vec3 to_light{0.0f};    ///< unit
  float distance = 0.0f;       ///< world units; infinity for a directional light
  float attenuation = 0.0f;    ///< irradiance over intensity
  glm::vec3 irradiance{0.0f};  ///< W/m^2 on a surface that faces the light
};

/// Point: I/d^2. Spot: the same times glTF's angular attenuation, clamp((cos - cos_outer)/(cos_inner - cos_outer), 0,
/// 1) squared, the denominator at least 0.001. Directional: E. A point on the light itself gets zero.
/// With the attenuated falloff the intensity counts as the irradiance at distance 0, and a spot's ramp is smoothstep's:
/// t^2 (3 - 2 t), whatever the denominator (spec section 3, villegas2016).
Illumination illuminate(const Light& light, const glm::vec3& point, const LightOptions& options = {});

/// Directional lights, then points, then spots: the order in which the published shaders sum them.
std::vector<Light> by_type(std::vector<Light> lights);

}  // namespace voxref
