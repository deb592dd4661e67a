#include "scene/gltf_material.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace voxref {
namespace {

Wrap read_wrap(const GltfValue& sampler, const std::string& key) {
  constexpr uint64_t repeat = 10497, clamp = 33071, mirror = 33648;
  const uint64_t code = sampler.integer(key, repeat);
  if (code != repeat && code != clamp && code != mirror)
    sampler.at(key).fail(fmt::format("unknown wrap mode {}", code));
  return code == repeat ? Wrap::repeat : code == clamp ? Wrap::clamp : Wrap::mirror;
}

/// Filters decide at magnification only: the mean over a pixel's samples is the minification filter.
void read_sampler(const GltfValue& sampler, TextureBinding& binding) {
  constexpr uint64_t nearest = 9728, linear = 9729, first_mipmap = 9984, last_mipmap = 9987;
  binding.wrap_s = read_wrap(sampler, "wrapS");
  binding.wrap_t = read_wrap(sampler, "wrapT");
  const uint64_t magnify = sampler.integer("magFilter", linear), minify = sampler.integer("minFilter", linear);
  if (magnify != nearest && magnify != linear) sampler.at("magFilter").fail(fmt::format("unknown filter {}", magnify));
  if (minify != nearest && minify != linear && (minify < first_mipmap || minify > last_mipmap))
    sampler.at("minFilter").fail(fmt::format("unknown filter {}", minify));
  binding.nearest = magnify == nearest;
}

/// The textures of the document: everything of a binding that the material does not say.
std::vector<TextureBinding> read_textures(GltfDocument& document) {
  const std::vector<GltfValue> samplers = document.list("samplers");
  std::vector<TextureBinding> sampler_bindings(samplers.size());
  for (size_t i = 0; i < samplers.size(); ++i) read_sampler(samplers[i], sampler_bindings[i]);

  std::vector<TextureBinding> textures;
  for (const GltfValue& value : document.list("textures")) {
    TextureBinding binding;
    if (const auto sampler = value.index("sampler", samplers.size(), "samplers")) binding = sampler_bindings[*sampler];
    const auto source = value.index("source", document.count("images"), "images");
    if (source)
      binding.image = static_cast<int>(*source);
    else
      warn_once(document.warnings, "textures without a PNG or JPEG image are ignored");
    textures.push_back(binding);
  }
  return textures;
}

/// KHR_texture_transform: uv' = translation * rotation * scale * uv, where a positive angle turns the coordinates
/// counter-clockwise as seen on the image, whose v axis points down.
glm::mat3x2 read_transform(const GltfValue& value) {
  const glm::vec2 offset = value.vector<2>("offset", glm::vec2(0.0f));
  const glm::vec2 scale = value.vector<2>("scale", glm::vec2(1.0f));
  const float angle = value.number("rotation", 0.0f);
  const float c = std::cos(angle), s = std::sin(angle);
  return {glm::vec2(c, -s) * scale.x, glm::vec2(s, c) * scale.y, offset};
}

class MaterialReader {
 public:
  MaterialReader(GltfDocument& document, float light_scale)
      : document_(document), light_scale_(light_scale), textures_(read_textures(document)) {}

  Material read(const GltfValue& value) const {
    Material material;
    material.name = value.text("name");
    read_surface(value, material);
    read_emission(value, material);
    read_alpha(value, material);
    material.double_sided = value.boolean("doubleSided", false);
    if (const auto normal = value.find("normalTexture")) {
      material.normal_texture = bind(value, "normalTexture", false);
      material.normal_scale = normal->number("scale", 1.0f);
    }
    if (value.find("occlusionTexture")) {
      bind(value, "occlusionTexture", false);
      warn_once(document_.warnings, "occlusion textures are ignored: occlusion is computed");
    }
    return material;
  }

 private:
  /// The texture that `key` names, none if it is not there.
  TextureBinding bind(const GltfValue& parent, const std::string& key, bool srgb) const {
    const auto info = parent.find(key);
    if (!info) return {};
    TextureBinding binding = textures_[info->at("index").index(textures_.size(), "textures")];
    GltfValue uv_holder = *info;
    if (const auto transform = info->extension("KHR_texture_transform")) {
      binding.transform = read_transform(*transform);
      if (transform->find("texCoord")) uv_holder = *transform;
    }
    const uint64_t uv_set = uv_holder.integer("texCoord", 0);
    if (uv_set > 1) uv_holder.at("texCoord").fail(fmt::format("TEXCOORD_{}: only 0 and 1 are supported", uv_set));
    binding.uv_set = static_cast<int>(uv_set);
    binding.srgb = srgb;
    return binding;
  }

  void read_surface(const GltfValue& value, Material& material) const {
    if (const auto gloss = value.extension("KHR_materials_pbrSpecularGlossiness")) {
      material.workflow = Workflow::specular_glossiness;
      material.base_color = gloss->vector<4>("diffuseFactor", glm::vec4(1.0f), Range::unit());
      material.base_color_texture = bind(*gloss, "diffuseTexture", true);
      material.specular_color = gloss->vector<3>("specularFactor", glm::vec3(1.0f), Range::unit());
      material.glossiness = gloss->number("glossinessFactor", 1.0f, Range::unit());
      material.specular_color_texture = bind(*gloss, "specularGlossinessTexture", true);
      return;
    }
    if (const auto pbr = value.find("pbrMetallicRoughness")) {
      material.base_color = pbr->vector<4>("baseColorFactor", glm::vec4(1.0f), Range::unit());
      material.base_color_texture = bind(*pbr, "baseColorTexture", true);
      material.metallic = pbr->number("metallicFactor", 1.0f, Range::unit());
      material.roughness = pbr->number("roughnessFactor", 1.0f, Range::unit());
      material.metallic_roughness_texture = bind(*pbr, "metallicRoughnessTexture", false);
    }
    if (const auto specular = value.extension("KHR_materials_specular")) {
      material.specular = specular->number("specularFactor", 1.0f, Range::unit());
      material.specular_texture = bind(*specular, "specularTexture", false);
      // May exceed 1; the extension clamps the product with F0 instead.
      material.specular_color = specular->vector<3>("specularColorFactor", glm::vec3(1.0f), Range::from(0.0));
      material.specular_color_texture = bind(*specular, "specularColorTexture", true);
    }
  }

  void read_emission(const GltfValue& value, Material& material) const {
    glm::vec3 emission = value.vector<3>("emissiveFactor", glm::vec3(0.0f), Range::unit());
    if (const auto strength = value.extension("KHR_materials_emissive_strength"))
      emission *= strength->number("emissiveStrength", 1.0f, Range::from(0.0));
    material.emission = emission * light_scale_;
    if (!std::isfinite(glm::dot(material.emission, glm::vec3(1.0f)))) value.fail("the emission is too large");
    material.emission_texture = bind(value, "emissiveTexture", true);
  }

  void read_alpha(const GltfValue& value, Material& material) const {
    const std::string mode = value.text("alphaMode", "OPAQUE");
    if (mode == "MASK")
      material.alpha_mode = AlphaMode::mask;
    else if (mode == "BLEND")
      warn_once(document_.warnings, "alphaMode BLEND is rendered opaque");
    else if (mode != "OPAQUE")
      value.at("alphaMode").fail("must be OPAQUE, MASK or BLEND");
    material.alpha_cutoff = value.number("alphaCutoff", 0.5f, Range::from(0.0));
  }

  GltfDocument& document_;
  float light_scale_;
  std::vector<TextureBinding> textures_;
};

}  // namespace

std::vector<Material> read_materials(GltfDocument& document, float light_scale) {
  const MaterialReader reader(document, light_scale);
  std::vector<Material> materials;
  for (const GltfValue& value : document.list("materials")) materials.push_back(reader.read(value));
  return materials;
}

}  // namespace voxref
