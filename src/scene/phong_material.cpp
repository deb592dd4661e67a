#include "scene/phong_material.h"

#include <glm/common.hpp>

#include "scene/texture_reader.h"

namespace voxref {

float diffuse_share(const Material& material, float metallic_texel) {
  return material.workflow == Workflow::specular_glossiness ? 1.0f : 1.0f - material.metallic * metallic_texel;
}

PhongMaterial phong_material(const Scene& scene, uint32_t triangle, const glm::vec2& uv, bool decode_textures) {
  const Material& m = scene.materials[scene.triangle_materials[triangle]];
  const MaterialInputs inputs = inputs_at(scene, scene.triangles[triangle], uv);
  const TextureReader texture{scene, inputs.uv};
  const auto color = [&](TextureBinding binding) {
    binding.srgb = binding.srgb && decode_textures;
    return texture(binding);
  };

  const glm::vec3 base = glm::vec3(m.base_color * color(m.base_color_texture) * inputs.color);
  const glm::vec4 metal_rough = texture(m.metallic_roughness_texture);
  PhongMaterial phong;
  phong.diffuse = diffuse_share(m, metal_rough.b) * base;
  phong.emission = m.emission * glm::vec3(color(decode_textures ? m.emission_texture : m.base_color_texture));
  const glm::vec4 specular_color = color(m.specular_color_texture);
  if (m.workflow == Workflow::specular_glossiness) {
    phong.specular = m.specular_color * glm::vec3(specular_color);
    phong.glossiness = m.glossiness * specular_color.a;
    return phong;
  }
  constexpr float dielectric_f0 = 0.04f;  // refractive index 1.5, as glTF fixes it
  const float metallic = m.metallic * metal_rough.b, strength = m.specular * texture(m.specular_texture).a;
  const glm::vec3 f0 = glm::min(dielectric_f0 * m.specular_color * glm::vec3(specular_color), glm::vec3(1.0f));
  phong.specular = glm::mix(strength * f0, base, metallic);
  phong.glossiness = glm::clamp(1.0f - m.roughness * metal_rough.g, 0.0f, 1.0f);
  return phong;
}

}  // namespace voxref
