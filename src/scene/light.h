#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>

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

/// What a light does at a point, shadows left out.
struct Illumination {
  glm::vec3 to_light{0.0f};    ///< unit
  float distance = 0.0f;       ///< world units; infinity for a directional light
  glm::vec3 irradiance{0.0f};  ///< W/m^2 on a surface that faces the light
};

/// Point: I/d^2. Spot: the same times glTF's angular attenuation, clamp((cos - cos_outer)/(cos_inner - cos_outer), 0,
/// 1) squared, the denominator at least 0.001. Directional: E. A point on the light itself gets zero.
Illumination illuminate(const Light& light, const glm::vec3& point);

}  // namespace voxref
