#include "scene/gltf_material.h"

#include <cmath>

#include "catch.h"
#include "scene/gltf.h"
#include "scene/gltf_builder.h"

namespace {

using nlohmann::json;
using voxref::Material;

// 2 x 1 texels: RGBA of 8 bits (255,128,0,64) (1,2,3,4), and RGB of 16 bits (0x1234,0x8000,0xffff) (1,2,3).
const char* const png8 =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP438DgwMjEzAIADNUByn7objcAAAAASUVORK5CYII=";
const char* const png16 =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR4nGMQMmlg+P+fgZGBiYEZABcgAsvQk1EnAAAAAElFTkSuQmCC";

voxref::Scene load(const json& material, float light_scale = 1.0f) {
  GltfBuilder builder;
  builder.json["images"] = {{{"uri", png8}}, {{"uri", png16}}};
  builder.json["samplers"] =
      R"([{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}, {"magFilter": 9729, "minFilter": 9984}])"_json;
  builder.json["textures"] = R"([{"source": 0}, {"source": 1, "sampler": 0}, {"source": 0, "sampler": 1}, {}])"_json;
  builder.json["materials"].push_back(material);
  const TemporaryFolder folder;
  voxref::LoadOptions options;
  options.light_scale = light_scale;
  return voxref::load_gltf(folder.write("scene.gltf", builder.text()), options);
}

Material material(const json& value, float light_scale = 1.0f) { return load(value, light_scale).materials.at(0); }

}  // namespace

TEST_CASE("An empty material has glTF's defaults", "[gltf]") {
  const Material m = material(json::object());
  CHECK(m.workflow == voxref::Workflow::metallic_roughness);
  CHECK(m.base_color == glm::vec4(1));
  CHECK(m.metallic == 1.0f);
  CHECK(m.roughness == 1.0f);
  CHECK(m.specular == 1.0f);
  CHECK(m.specular_color == glm::vec3(1));
  CHECK_FALSE(m.emissive());
  CHECK(m.alpha_mode == voxref::AlphaMode::opaque);
  CHECK_FALSE(m.double_sided);
  CHECK_FALSE(m.base_color_texture);
}

TEST_CASE("Metallic-roughness materials keep all their factors and textures", "[gltf]") {
  const Material m = material(R"({"name": "m", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
    "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
      "baseColorTexture": {"index": 0, "texCoord": 1}, "metallicRoughnessTexture": {"index": 1}},
    "normalTexture": {"index": 1, "scale": -2},
    "emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 2},
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8},
      "KHR_materials_specular": {"specularFactor": 0.7, "specularTexture": {"index": 2},
        "specularColorFactor": [3, 2, 1], "specularColorTexture": {"index": 0}}}})"_json,
                              3.0f);
  CHECK(m.name == "m");
  CHECK(m.double_sided);
  CHECK(m.alpha_mode == voxref::AlphaMode::mask);
  CHECK(m.alpha_cutoff == 0.25f);
  CHECK(m.base_color == glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  CHECK(m.metallic == 0.5f);
  CHECK(m.roughness == 0.6f);
  CHECK(m.base_color_texture.uv_set == 1);
  CHECK(m.base_color_texture.srgb);
  CHECK(m.base_color_texture.image == 0);
  CHECK_FALSE(m.metallic_roughness_texture.srgb);
  CHECK(m.metallic_roughness_texture.image == 1);
  CHECK_FALSE(m.normal_texture.srgb);
  CHECK(m.normal_scale == -2.0f);
  CHECK(m.emission == glm::vec3(24, 12, 0));  // factor x strength x light scale
  CHECK(m.emission_texture.srgb);
  CHECK(m.specular == 0.7f);
  CHECK(m.specular_texture);
  CHECK_FALSE(m.specular_texture.srgb);
  CHECK(m.specular_color == glm::vec3(3, 2, 1));
  CHECK(m.specular_color_texture.srgb);
}

TEST_CASE("Specular-glossiness materials keep theirs", "[gltf]") {
  const Material m = material(R"({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 0]},
    "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.1, 0.2, 0.3, 0.4],
      "specularFactor": [0.5, 0.6, 0.7], "glossinessFactor": 0.8,
      "diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 2}}}})"_json);
  CHECK(m.workflow == voxref::Workflow::specular_glossiness);
  CHECK(m.base_color == glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  CHECK(m.specular_color == glm::vec3(0.5f, 0.6f, 0.7f));
  CHECK(m.glossiness == 0.8f);
  CHECK(m.base_color_texture.srgb);
  CHECK(m.specular_color_texture.srgb);
}

TEST_CASE("Samplers decide wrapping and, at magnification, filtering", "[gltf]") {
  const auto binding = [](int texture) {
    return material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}}).base_color_texture;
  };
  CHECK(binding(0).wrap_s == voxref::Wrap::repeat);
  CHECK_FALSE(binding(0).nearest);
  CHECK(binding(1).wrap_s == voxref::Wrap::clamp);
  CHECK(binding(1).wrap_t == voxref::Wrap::mirror);
  CHECK(binding(1).nearest);
  CHECK_FALSE(binding(2).nearest);
  CHECK_FALSE(binding(3));
}

TEST_CASE("KHR_texture_transform scales, then turns counter-clockwise, then moves", "[gltf]") {
  const voxref::TextureBinding binding = material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
    "extensions": {"KHR_texture_transform":
      {"offset": [10, 20], "rotation": 1.5707963267948966, "scale": [2, 3], "texCoord": 1}}}}})"_json)
                                             .base_color_texture;
  CHECK(binding.uv_set == 1);
  // Right, (1, 0), becomes 2 to the right, turns to 2 up on the image, whose v points down, and moves.
  const glm::vec2 right = binding.transform * glm::vec3(1, 0, 1), down = binding.transform * glm::vec3(0, 1, 1);
  CHECK(right.x == Approx(10.0f));
  CHECK(right.y == Approx(18.0f));
  CHECK(down.x == Approx(13.0f));
  CHECK(down.y == Approx(20.0f));
}

TEST_CASE("The transform turns the arrow of TextureTransformTest to its green mark", "[gltf]") {
  const auto file = shared_file("assets/loaders/TextureTransformTest/TextureTransformTest.gltf");
  if (!file) VOXREF_SKIP("assets/loaders is absent");
  const voxref::Scene scene = voxref::load_gltf(*file);
  const glm::mat3x2& transform = scene.materials.at(3).base_color_texture.transform;
  // The mark's node lies at (-0.0790, -0.5163) from the quad's centre, so at texture coordinate (0.4210, 1.0163); there
  // the quad must show the image's diagonal, along which the arrow points.
  const glm::vec2 uv = transform * glm::vec3(0.42095f, 1.01627f, 1.0f);
  CHECK(uv.x == Approx(uv.y).margin(1e-4));  // four digits of the mark's place
}

TEST_CASE("Images keep their 8 or 16 bits and become RGBA", "[gltf]") {
  const voxref::Scene scene = load(json::object());
  REQUIRE(scene.images.size() == 2);
  CHECK(scene.images[0].width == 2);
  CHECK(scene.images[0].height == 1);
  CHECK(scene.images[0].texels8 == std::vector<uint8_t>{255, 128, 0, 64, 1, 2, 3, 4});
  CHECK(scene.images[0].texels16.empty());
  CHECK(scene.images[1].texels8.empty());
  CHECK(scene.images[1].texels16 == std::vector<uint16_t>{0x1234, 0x8000, 0xffff, 0xffff, 1, 2, 3, 0xffff});
}

TEST_CASE("What a material asks for in vain is said once", "[gltf]") {
  const auto warnings = load(R"({"alphaMode": "BLEND", "occlusionTexture": {"index": 0}})"_json).warnings;
  CHECK(warnings == std::vector<std::string>{"textures without a PNG or JPEG image are ignored",
                                             "alphaMode BLEND is rendered opaque",
                                             "occlusion textures are ignored: occlusion is computed"});
}
