#include <limits>
#include <random>

#include "catch.h"
#include "error.h"
#include "scene/gltf.h"
#include "scene/gltf_builder.h"

namespace {

using nlohmann::json;

/// The message with which the file is refused, without the file's name; empty when it is accepted.
std::string refusal(const std::filesystem::path& file) {
  try {
    voxref::validate(voxref::load_gltf(file));
    return "";
  } catch (const voxref::Error& error) {
    const std::string message = error.what(), start = file.string() + ": ";
    CHECK(message.starts_with(start));
    CHECK(message.find('\n') == std::string::npos);
    return message.substr(std::min(start.size(), message.size()));
  }
}

std::string refusal(const std::string& content, const std::string& name = "scene.gltf") {
  const TemporaryFolder folder;
  return refusal(folder.write(name, content));
}

/// A document with one of everything.
GltfBuilder everything() {
  GltfBuilder builder = unit_square();
  json& attributes = builder.primitive()["attributes"];
  attributes["NORMAL"] = builder.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);  // accessor 2
  attributes["TEXCOORD_0"] = builder.accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, 2);          // accessor 3
  const size_t times = builder.accessor<float>({0, 1}, 1);                                  // accessor 4
  const size_t values = builder.accessor<float>({0, 0, 0, 1, 0, 0}, 3);                     // accessor 5
  const size_t sparse_index = builder.view<uint16_t>({1}), sparse_value = builder.view<float>({1, 0, 0});
  builder.json["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", sparse_index}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", sparse_value}}}};
  builder.primitive()["material"] = 0;
  builder.json["images"] =
      R"([{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP438DgwMjEzAIADNUByn7objcAAAAASUVORK5CYII="}])"_json;
  builder.json["samplers"] = R"([{"magFilter": 9728, "wrapS": 10497}])"_json;
  builder.json["textures"] = R"([{"source": 0, "sampler": 0}])"_json;
  builder.json["materials"] = R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
    "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1},
    "normalTexture": {"index": 0}, "emissiveFactor": [0, 0, 0], "alphaMode": "MASK", "alphaCutoff": 0.5,
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1}}}])"_json;
  builder.json["cameras"] = R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}])"_json;
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] =
      R"([{"type": "spot", "intensity": 1, "color": [1, 1, 1], "spot": {"outerConeAngle": 0.5}}])"_json;
  builder.json["nodes"] = R"([{"mesh": 0, "children": [1], "rotation": [0, 0, 0, 1]},
    {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}])"_json;
  builder.json["scenes"] = R"([{"nodes": [0]}])"_json;
  builder.json["scene"] = 0;
  builder.json["animations"] = {{{"samplers", {{{"input", times}, {"output", values}}}},
                                 {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  return builder;
}

struct Damage {
  const char* pointer;  ///< JSON pointer of the value to replace
  const char* value;    ///< JSON
  const char* place;    ///< where the refusal must point
};

// What tinygltf 2.7 accepts, or accepts with a default in its place, and what it must not.
const Damage damages[] = {
    {"/asset", "{}", "asset.version"},
    {"/asset/version", "\"1.0\"", "asset.version"},
    {"/asset/version", "2", "asset.version"},
    {"/extensionsRequired", "[\"KHR_draco_mesh_compression\"]", "extensionsRequired[0]"},
    {"/scene", "1", "scene"},
    {"/scene", "\"0\"", "scene"},
    {"/scenes/0/nodes", "[2]", "scenes[0].nodes[0]"},
    {"/scenes/0/nodes", "[1]", "scenes[0].nodes[0]"},
    {"/scenes/0/nodes", "[0, 0]", "scenes[0].nodes[1]"},
    {"/nodes/0", "7", "nodes[0]"},
    {"/nodes/0/mesh", "1", "nodes[0].mesh"},
    {"/nodes/0/mesh", "-1", "nodes[0].mesh"},
    {"/nodes/0/mesh", "0.5", "nodes[0].mesh"},
    {"/nodes/0/mesh", "\"0\"", "nodes[0].mesh"},
    {"/nodes/0/mesh", "1e30", "nodes[0].mesh"},
    {"/nodes/0/children", "[9]", "nodes[0].children[0]"},
    {"/nodes/0/children", "[1, 1]", "nodes[0].children[1]"},
    {"/nodes/0/children", "[0]", "nodes[0]"},
    {"/nodes/1/children", "[0]", "nodes[0]"},
    {"/nodes/0/skin", "0", "nodes[0].skin"},
    {"/nodes/0/rotation", "[0, 0, 0, 0]", "nodes[0].rotation"},
    {"/nodes/0/rotation", "[1, 1, 1, 1]", "nodes[0].rotation"},
    {"/nodes/0/rotation", "[0, 0, 1]", "nodes[0].rotation"},
    {"/nodes/0/translation", "[0, 1e39, 0]", "nodes[0].translation[1]"},
    {"/nodes/0/translation", "[0, null, 0]", "nodes[0].translation[1]"},
    {"/nodes/0/scale", "[3e38, 3e38, 3e38]", ""},  // finite, and so are the vertices
    {"/nodes/0/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]", "nodes[0]"},
    {"/nodes/1/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]", "nodes[1].matrix"},
    {"/nodes/1/matrix", "[0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1]", "nodes[1]"},
    {"/nodes/1/camera", "1", "nodes[1].camera"},
    {"/nodes/1/extensions/KHR_lights_punctual/light", "1", "nodes[1].extensions.KHR_lights_punctual.light"},
    {"/cameras/0/type", "\"fisheye\"", "cameras[0].type"},
    {"/cameras/0/perspective/yfov", "0", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/yfov", "4", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective", "{}", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/aspectRatio", "-1", "cameras[0].perspective.aspectRatio"},
    {"/extensions/KHR_lights_punctual/lights/0/type", "\"area\"", "extensions.KHR_lights_punctual.lights[0].type"},
    {"/extensions/KHR_lights_punctual/lights/0/intensity", "-1", "extensions.KHR_lights_punctual.lights[0].intensity"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "[1, 1]", "extensions.KHR_lights_punctual.lights[0].color"},
    {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", "3",
     "extensions.KHR_lights_punctual.lights[0].spot.outerConeAngle"},
    {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", "0.5",
     "extensions.KHR_lights_punctual.lights[0].spot"},
    {"/meshes/0/primitives", "{}", "meshes[0].primitives"},
    {"/meshes/0/primitives/0/mode", "7", "meshes[0].primitives[0].mode"},
    {"/meshes/0/primitives/0/material", "1", "meshes[0].primitives[0].material"},
    {"/meshes/0/primitives/0/indices", "99", "meshes[0].primitives[0].indices"},
    {"/meshes/0/primitives/0/indices", "\"1\"", "meshes[0].primitives[0].indices"},
    {"/meshes/0/primitives/0/indices", "0", "meshes[0].primitives[0].indices"},
    {"/meshes/0/primitives/0/attributes/POSITION", "99", "meshes[0].primitives[0].attributes.POSITION"},
    {"/meshes/0/primitives/0/attributes/POSITION", "3", "meshes[0].primitives[0].attributes.POSITION"},
    {"/meshes/0/primitives/0/attributes/NORMAL", "5", "meshes[0].primitives[0].attributes.NORMAL"},
    {"/meshes/0/primitives/0/attributes/COLOR_0", "1", "meshes[0].primitives[0].attributes.COLOR_0"},
    {"/meshes/0/primitives/0/attributes/_OWN", "99", "meshes[0].primitives[0].attributes._OWN"},
    {"/accessors/0/count", "5", "accessors[0]"},
    {"/accessors/0/count", "4000000000", "accessors[0]"},
    {"/accessors/0/count", "0", "accessors[0].count"},
    {"/accessors/0/count", "-4", "accessors[0].count"},
    {"/accessors/1/count", "5", "meshes[0].primitives[0]"},
    {"/accessors/2/count", "3", "meshes[0].primitives[0].attributes.NORMAL"},
    {"/accessors/0/type", "\"VEC5\"", "accessors[0].type"},
    {"/accessors/0/componentType", "5124", "accessors[0].componentType"},
    {"/accessors/0/componentType", "5130", "accessors[0].componentType"},
    {"/accessors/0/normalized", "true", "accessors[0].normalized"},
    {"/accessors/0/normalized", "1", "accessors[0].normalized"},
    {"/accessors/0/byteOffset", "4", "accessors[0]"},
    {"/accessors/0/byteOffset", "-4", "accessors[0].byteOffset"},
    {"/accessors/1/byteOffset", "1", "accessors[1]"},
    {"/accessors/0/bufferView", "99", "accessors[0].bufferView"},
    {"/accessors/0/sparse/count", "5", "accessors[0].sparse.count"},
    {"/accessors/0/sparse/count", "2", "accessors[0].sparse.indices"},
    {"/accessors/0/sparse/indices/bufferView", "99", "accessors[0].sparse.indices.bufferView"},
    {"/accessors/0/sparse/indices/componentType", "5126", "accessors[0].sparse.indices.componentType"},
    {"/accessors/0/sparse/values", "{}", "accessors[0].sparse.values.bufferView"},
    {"/bufferViews/0/buffer", "1", "bufferViews[0].buffer"},
    {"/bufferViews/0/byteOffset", "1000000", "bufferViews[0]"},
    {"/bufferViews/0/byteLength", "1000000", "bufferViews[0]"},
    {"/bufferViews/0/byteLength", "0", "bufferViews[0].byteLength"},
    {"/bufferViews/0/byteLength", "\"48\"", "bufferViews[0].byteLength"},
    {"/bufferViews/0/byteStride", "8", "accessors[0]"},
    {"/bufferViews/0/byteStride", "13", "bufferViews[0].byteStride"},
    {"/bufferViews/0/byteStride", "16", "accessors[0]"},
    {"/bufferViews/0/byteStride", "-12", "bufferViews[0].byteStride"},
    {"/buffers", "[{\"byteLength\": 300}]", "buffers[0].uri"},
    {"/buffers", "[{\"byteLength\": 300, \"uri\": \"absent.bin\"}]", "buffers[0]"},
    {"/buffers", "[{\"byteLength\": 300, \"uri\": \"data:application/octet-stream;base64,AA=!\"}]", "buffers[0]"},
    {"/buffers", "[{\"byteLength\": -1, \"uri\": \"absent.bin\"}]", "buffers[0].byteLength"},
    {"/images/0/uri", "\"absent.png\"", "images[0]"},
    {"/images/0/uri", "\"data:image/png;base64,AAAA\"", "images[0]"},
    {"/images/0/bufferView", "0", "images[0]"},
    {"/images/0", "{}", "images[0]"},
    {"/images/0", "{\"bufferView\": 99}", "images[0].bufferView"},
    {"/images/0", "{\"bufferView\": 0}", "images[0]"},
    {"/samplers/0/wrapS", "1", "samplers[0].wrapS"},
    {"/samplers/0/magFilter", "9984", "samplers[0].magFilter"},
    {"/textures/0/source", "1", "textures[0].source"},
    {"/textures/0/sampler", "1", "textures[0].sampler"},
    {"/materials/0/pbrMetallicRoughness", "[]", "materials[0].pbrMetallicRoughness"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1.5, 1, 1]",
     "materials[0].pbrMetallicRoughness.baseColorFactor[1]"},
    {"/materials/0/pbrMetallicRoughness/metallicFactor", "\"1\"", "materials[0].pbrMetallicRoughness.metallicFactor"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "1",
     "materials[0].pbrMetallicRoughness.baseColorTexture.index"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "2",
     "materials[0].pbrMetallicRoughness.baseColorTexture.texCoord"},
    {"/materials/0/normalTexture", "{}", "materials[0].normalTexture.index"},
    {"/materials/0/emissiveFactor", "[-1, 0, 0]", "materials[0].emissiveFactor[0]"},
    {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "-1",
     "materials[0].extensions.KHR_materials_emissive_strength.emissiveStrength"},
    {"/materials/0/alphaMode", "\"mask\"", "materials[0].alphaMode"},
    {"/materials/0/doubleSided", "1", "materials[0].doubleSided"},
    {"/animations/0/samplers/0/input", "99", "animations[0].samplers[0].input"},
    {"/animations/0/samplers/0/output", "4", "animations[0].samplers[0].output"},
    {"/animations/0/channels/0/sampler", "1", "animations[0].channels[0].sampler"},
    {"/animations/0/channels/0/target/node", "9", "animations[0].channels[0].target.node"},
};

}  // namespace

TEST_CASE("Each damage to a document is refused with its place", "[gltf]") {
  REQUIRE(refusal(everything().text()) == "");
  for (const Damage& damage : damages) {
    GltfBuilder builder = everything();
    builder.json[json::json_pointer(damage.pointer)] = json::parse(damage.value);
    const std::string message = refusal(builder.text());
    INFO(damage.pointer << " = " << damage.value << " -> " << message);
    const std::string place = damage.place;
    CHECK((place.empty() ? message.empty() : message.starts_with(place + ": ")));
  }
}

TEST_CASE("Numbers in buffers are checked as those in the document are", "[gltf]") {
  GltfBuilder builder = everything();
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  SECTION("index beyond the vertices") {
    builder.primitive()["indices"] = builder.accessor<uint8_t>({0, 1, 4}, 1);
    CHECK(refusal(builder.text()).starts_with("meshes[0].primitives[0].indices: index 2 is 4"));
  }
  SECTION("position") {
    builder.primitive()["attributes"]["POSITION"] = builder.accessor<float>({0, 0, 0, 1, nan, 0, 1, 1, 0, 0, 1, 0}, 3);
    CHECK(refusal(builder.text()).starts_with("accessors[6]: element 1 is not finite"));
  }
  SECTION("normal") {
    builder.primitive()["attributes"]["NORMAL"] =
        builder.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, infinity, 0, 0}, 3);
    CHECK(refusal(builder.text()).starts_with("accessors[6]: element 3 is not finite"));
  }
  SECTION("sparse index") {
    const size_t view = builder.view<uint16_t>({4});
    builder.json["accessors"][0]["sparse"]["indices"]["bufferView"] = view;
    CHECK(refusal(builder.text()).starts_with("accessors[0].sparse.indices: index 4"));
  }
  SECTION("sparse indices that do not increase") {
    const size_t indices = builder.view<uint16_t>({2, 1}), values = builder.view<float>({1, 0, 0, 1, 0, 0});
    nlohmann::json& sparse = builder.json["accessors"][0]["sparse"];
    sparse["count"] = 2;
    sparse["indices"]["bufferView"] = indices;
    sparse["values"]["bufferView"] = values;
    CHECK(refusal(builder.text()).starts_with("accessors[0].sparse.indices: index 1 after 2"));
  }
  SECTION("a vertex out of range") {
    builder.json["nodes"][0]["scale"] = {1e30, 1, 1};
    builder.primitive()["attributes"]["POSITION"] =
        builder.accessor<float>({0, 0, 0, 1e30f, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
    CHECK(refusal(builder.text()).starts_with("nodes[0]: "));
  }
}

TEST_CASE("Quantized positions need the extension that allows them", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.primitive()["attributes"]["POSITION"] = builder.accessor<uint16_t>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
  CHECK(refusal(builder.text()).starts_with("meshes[0].primitives[0].attributes.POSITION: "));
}

TEST_CASE("An accessor without bytes cannot ask for gigabytes", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.json["accessors"][0].erase("bufferView");
  builder.json["accessors"][0]["count"] = 4000000000u;
  CHECK(refusal(builder.text()).starts_with("accessors[0].count: "));
}

TEST_CASE("Files that are no glTF files are refused", "[gltf]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(voxref::load_gltf(folder.path / "absent.glb"), voxref::Error);
  CHECK(refusal(folder.path).starts_with("file: "));
  CHECK(refusal("", "scene.gltf").starts_with("JSON: "));
  CHECK(refusal("hello", "scene.gltf").starts_with("JSON: "));
  CHECK(refusal("[1, 2]", "scene.gltf").starts_with("document: "));
  CHECK(refusal("{\"asset\": {\"version\": \"2.0\"}", "scene.gltf").starts_with("JSON: "));
  CHECK(refusal(unit_square().text(), "scene.glb").starts_with("GLB header: "));
  CHECK(refusal("", "scene.glb").starts_with("GLB header: "));
}

TEST_CASE("A document nested too deep for the stack is refused", "[gltf]") {
  GltfBuilder builder = unit_square();
  std::string text = builder.text();
  text.insert(1, "\"extras\": " + std::string(200000, '[') + std::string(200000, ']') + ",");
  CHECK(refusal(text).starts_with("JSON: nested"));
}

TEST_CASE("A long chain of nodes needs no stack", "[gltf]") {
  GltfBuilder builder = unit_square();
  const int length = 20000;
  for (int i = 0; i + 1 < length; ++i) builder.json["nodes"][i] = {{"children", {i + 1}}};
  builder.json["nodes"][length - 1] = {{"mesh", 0}};
  CHECK(refusal(builder.text()) == "");
}

TEST_CASE("A GLB file cut off anywhere is refused", "[gltf]") {
  const std::string whole = everything().glb();
  REQUIRE(refusal(whole, "scene.glb") == "");
  for (size_t length = 0; length < whole.size(); length += 7)
    CHECK(refusal(whole.substr(0, length), "scene.glb").starts_with("GLB header: "));
  std::string lying = whole;  // the BIN chunk claims eight bytes more than there are
  const size_t chunk = whole.find(std::string("BIN\0", 4)) - 4;
  lying.replace(chunk, 4, word(static_cast<uint32_t>(whole.size() - chunk)));
  CHECK(refusal(lying, "scene.glb").starts_with("GLB header: "));
}

TEST_CASE("A file with random damage is either refused or a valid scene", "[gltf]") {
  std::mt19937 random(7);
  const std::string text = everything().text(), binary = everything().glb();
  for (int trial = 0; trial < 3000; ++trial) {
    std::string damaged = trial % 2 ? text : binary;
    const auto below = [&](size_t count) { return std::uniform_int_distribution<size_t>(0, count - 1)(random); };
    for (size_t k = 0; k <= below(3); ++k) {
      // Bytes that keep JSON alive: digits, signs and brackets; in the binary part any byte is as good as another.
      const std::string bytes = "0123456789-.e[]{},:\"\\ tfnul\x7f";
      damaged[below(damaged.size())] = bytes[below(bytes.size())];
    }
    refusal(damaged, trial % 2 ? "scene.gltf" : "scene.glb");  // throws nothing but Error, and its scenes are valid
  }
}
