#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace voxref {

/// A surface point in the terms of the published shaders, textures looked up.
struct PhongMaterial {
  glm::vec3 diffuse{0.0f};   ///< Kd
  glm::vec3 specular{0.0f};  ///< Ks
  float glossiness = 0.0f;   ///< s in [0,1]: the specular power is 2^(11 s + 1)
  glm::vec3 emission{0.0f};  ///< Ke, radiance
};

/// Share of the base colour that is Kd: all of it, but for what the metallic-roughness workflow makes a metal's Ks.
/// @param metallic_texel metallic in [0,1], of its texture
float diffuse_share(const Material& material, float metallic_texel);

/// KHR_materials_pbrSpecularGlossiness holds Kd, Ks and s as they are. Metallic-roughness is converted as that
/// extension says: Kd = base (1 - metallic), Ks = mix(0.04 x specular colour, base, metallic), s = 1 - roughness.
/// @param decode_textures false: colour textures are taken as the file holds them, sRGB-encoded, and emission takes the
/// base colour's texel, as where the published program binds that texture for both
PhongMaterial phong_material(const Scene& scene, uint32_t triangle, const glm::vec2& uv, bool decode_textures);

}  // namespace voxref
