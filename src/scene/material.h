#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>

#include "scene/texture.h"

namespace voxref {

enum class Workflow : uint8_t {
  metallic_roughness,  ///< glTF 2.0 core, with KHR_materials_specular
  specular_glossiness  ///< KHR_materials_pbrSpecularGlossiness
};
enum class AlphaMode : uint8_t { opaque, mask };

/// A glTF 2.0 material. Factors are linear and multiply their texture.
struct Material {
  std::string name;
  Workflow workflow = Workflow::metallic_roughness;

  glm::vec4 base_color{1.0f};  ///< diffuse colour in the specular-glossiness workflow; alpha is coverage
  TextureBinding base_color_texture;

  float metallic = 1.0f, roughness = 1.0f;
  TextureBinding metallic_roughness_texture;  ///< roughness in G, metallic in B

  float specular = 1.0f;                  ///< KHR_materials_specular: strength of the dielectric lobe
  glm::vec3 specular_color{1.0f};         ///< tint of its F0; F0 itself in the specular-glossiness workflow
  TextureBinding specular_texture;        ///< strength in A
  TextureBinding specular_color_texture;  ///< RGB; in specular-glossiness RGB is F0 and A is glossiness
  float glossiness = 1.0f;                ///< 1 - perceptual roughness, specular-glossiness only

  glm::vec3 emission{0.0f};  ///< radiance, W/(sr m^2): emissiveFactor x emissiveStrength
  TextureBinding emission_texture;

  TextureBinding normal_texture;  ///< tangent space, green = +bitangent
  float normal_scale = 1.0f;

  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;  ///< mask: alpha below it is a hole
  bool double_sided = false;  ///< emission leaves both sides

  bool emissive() const { return emission != glm::vec3(0.0f); }
};

}  // namespace voxref
