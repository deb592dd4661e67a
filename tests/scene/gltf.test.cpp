#include "scene/gltf.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "scene/gltf_builder.h"

namespace {

using nlohmann::json;
using voxref::Scene;

Scene load(const GltfBuilder& builder, const voxref::LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const Scene scene = voxref::load_gltf(folder.write("scene.gltf", builder.text()), options);
  voxref::validate(scene);
  return scene;
}

glm::vec3 face(const Scene& scene, const glm::uvec3& t) {
  const glm::vec3 a = scene.positions[t[0]];
  return 0.5f * glm::cross(scene.positions[t[1]] - a, scene.positions[t[2]] - a);
}

glm::vec3 area_vector(const Scene& scene) {
  glm::vec3 sum(0.0f);
  for (const glm::uvec3& triangle : scene.triangles) sum += face(scene, triangle);
  return sum;
}

bool warned(const Scene& scene, const std::string& words) {
  int count = 0;
  for (const std::string& line : scene.warnings) count += line.find(words) != std::string::npos;
  return count == 1;
}

}  // namespace

TEST_CASE("All modes of triangles show the same square from the front", "[gltf]") {
  GltfBuilder builder = unit_square();
  struct Mode {
    int mode;
    std::vector<uint16_t> indices;
  };
  // A strip goes zigzag, a fan round: both orders of the same corners.
  const Mode mode = GENERATE(Mode{4, {0, 1, 2, 0, 2, 3}}, Mode{5, {0, 1, 3, 2}}, Mode{6, {0, 1, 2, 3}});
  builder.primitive()["mode"] = mode.mode;
  builder.primitive()["indices"] = builder.accessor(mode.indices, 1);
  const Scene scene = load(builder);
  REQUIRE(scene.triangles.size() == 2);
  CHECK(area_vector(scene) == glm::vec3(0, 0, 1));
  for (const glm::uvec3& triangle : scene.triangles) CHECK(face(scene, triangle) == glm::vec3(0, 0, 0.5f));
  for (const glm::vec3& normal : scene.normals) CHECK(normal == glm::vec3(0, 0, 1));
}

TEST_CASE("A strip of five vertices keeps every triangle counter-clockwise", "[gltf]") {
  GltfBuilder builder;
  const size_t positions = builder.accessor<float>({0, 0, 0, 0, -1, 0, 1, 0, 0, 1, -1, 0, 2, 0, 0}, 3);
  builder.mesh({{"POSITION", positions}});
  builder.primitive()["mode"] = 5;
  builder.json["nodes"] = R"([{"mesh": 0}])"_json;
  const Scene scene = load(builder);
  REQUIRE(scene.triangles.size() == 3);
  for (const glm::uvec3& triangle : scene.triangles) CHECK(face(scene, triangle) == glm::vec3(0, 0, 0.5f));
}

TEST_CASE("Points and lines are ignored with one warning", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.primitive()["mode"] = GENERATE(0, 1, 2, 3);
  const Scene scene = load(builder);
  CHECK(scene.triangles.empty());
  CHECK(warned(scene, "points and lines"));
}

TEST_CASE("Every type of index means the same", "[gltf]") {
  GltfBuilder builder = unit_square();
  SECTION("8 bits") { builder.primitive()["indices"] = builder.accessor<uint8_t>({0, 1, 2, 0, 2, 3}, 1); }
  SECTION("32 bits") { builder.primitive()["indices"] = builder.accessor<uint32_t>({0, 1, 2, 0, 2, 3}, 1); }
  CHECK(area_vector(load(builder)) == glm::vec3(0, 0, 1));
}

TEST_CASE("Quantized attributes mean what their integers stand for", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  json& attributes = builder.primitive()["attributes"];
  SECTION("integers keep their value") {
    // Three 16-bit numbers per vertex and two bytes of padding: vertex data lies at multiples of four.
    builder.view<int16_t>({-2, 0, 0, 99, 2, 0, 0, 99, 2, 4, 0, 99, -2, 4, 0, 99});
    builder.json["bufferViews"].back()["byteStride"] = 8;
    builder.json["accessors"].push_back({{"bufferView", 2}, {"componentType", 5122}, {"count", 4}, {"type", "VEC3"}});
    attributes["POSITION"] = 2;
    CHECK(load(builder).positions[0] == glm::vec3(-2, 0, 0));
    CHECK(area_vector(load(builder)) == glm::vec3(0, 0, 16));
  }
  SECTION("normalized ones become -1 to 1") {
    builder.view<int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, -128, 0, 0, 0});
    builder.json["bufferViews"].back()["byteStride"] = 4;
    builder.json["accessors"].push_back(
        {{"bufferView", 2}, {"componentType", 5120}, {"count", 4}, {"type", "VEC3"}, {"normalized", true}});
    attributes["NORMAL"] = 2;
    const Scene scene = load(builder);
    CHECK(scene.normals[0] == glm::vec3(0, 0, 1));
    CHECK(scene.normals[3] == glm::vec3(-1, 0, 0));
  }
}

TEST_CASE("Vertex colours are read as floats and as normalized integers, with or without alpha", "[gltf]") {
  GltfBuilder builder = unit_square();
  json& attributes = builder.primitive()["attributes"];
  SECTION("float RGB") {
    attributes["COLOR_0"] = builder.accessor<float>({0, 0.5f, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3);
    CHECK(load(builder).colors[0] == glm::vec4(0, 0.5f, 1, 1));
  }
  SECTION("16-bit RGBA") {
    attributes["COLOR_0"] =
        builder.accessor<uint16_t>({0, 65535, 13107, 26214, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4, true);
    // Without NORMAL the corners of the two triangles stand side by side: 0 1 2, 0 2 3.
    CHECK(load(builder).colors[3] == glm::vec4(0, 1, 0.2f, 0.4f));
  }
  SECTION("out of range") {
    attributes["COLOR_0"] = builder.accessor<float>({0, 2, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3);
    CHECK(load(builder).colors[0] == glm::vec4(0, 1, 0, 1));
    CHECK(warned(load(builder), "vertex colours"));
  }
}

TEST_CASE("Sparse accessors replace some elements, with and without others to replace", "[gltf]") {
  GltfBuilder builder = unit_square();
  const size_t indices = builder.view<uint16_t>({1, 2}), values = builder.view<float>({3, 0, 0, 3, 1, 0});
  json& accessor = builder.json["accessors"][0];
  accessor["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                        {"values", {{"bufferView", values}}}};
  CHECK(area_vector(load(builder)) == glm::vec3(0, 0, 3));
  accessor.erase("bufferView");  // (0,0) (3,0) (3,1) (0,0): half of it
  CHECK(area_vector(load(builder)) == glm::vec3(0, 0, 1.5f));
}

TEST_CASE("Interleaved attributes are read at their stride", "[gltf]") {
  GltfBuilder builder;
  std::vector<float> vertices;
  for (const auto& [x, y] : {std::pair(0.f, 0.f), std::pair(2.f, 0.f), std::pair(0.f, 2.f)})
    vertices.insert(vertices.end(), {x, y, 5, 0, 0.6f, 0.8f});
  const size_t view = builder.view(vertices);
  builder.json["bufferViews"][view]["byteStride"] = 24;
  for (int offset : {0, 12})
    builder.json["accessors"].push_back(
        {{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  builder.mesh({{"POSITION", 0}, {"NORMAL", 1}});
  builder.json["nodes"] = R"([{"mesh": 0}])"_json;
  const Scene scene = load(builder);
  CHECK(scene.positions[1] == glm::vec3(2, 0, 5));
  for (const glm::vec3& normal : scene.normals) CHECK(glm::distance(normal, glm::vec3(0, 0.6f, 0.8f)) < 1e-6f);
}

TEST_CASE("Vertices that no triangle uses do not enter the scene", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.primitive()["attributes"]["NORMAL"] = builder.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  builder.primitive()["indices"] = builder.accessor<uint16_t>({1, 2, 3}, 1);
  const Scene scene = load(builder);
  CHECK(scene.positions == std::vector<glm::vec3>{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  CHECK(scene.triangles == std::vector<glm::uvec3>{{0, 1, 2}});
}

TEST_CASE("A normal without length becomes that of its triangles", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.primitive()["attributes"]["NORMAL"] = builder.accessor<float>({0, 0, 0, 0, 9, 0, 0, 0, 0, 1, 0, 0}, 3);
  const Scene scene = load(builder);
  CHECK(scene.normals == std::vector<glm::vec3>{{0, 0, 1}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}});
}

TEST_CASE("Degenerate triangles stay, with a finite normal", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.primitive()["indices"] = builder.accessor<uint16_t>({0, 1, 2, 3, 3, 3}, 1);
  const Scene scene = load(builder);
  CHECK(scene.triangles.size() == 2);
  for (const glm::vec3& normal : scene.normals) CHECK(glm::length(normal) == 1.0f);
}

TEST_CASE("Nodes place meshes by translation, rotation and scale or by the same matrix", "[gltf]") {
  GltfBuilder builder = unit_square();
  // A quarter turn about Z after doubling x: (x, y, z) -> (-y + 10, 2 x, z).
  SECTION("TRS") {
    builder.json["nodes"] = R"([{"children": [1], "translation": [10, 0, 0]},
      {"mesh": 0, "rotation": [0, 0, 0.70710678118, 0.70710678118], "scale": [2, 1, 1]}])"_json;
  }
  SECTION("matrix") {
    builder.json["nodes"] = R"([{"children": [1], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 10,0,0,1]},
      {"mesh": 0, "matrix": [0,2,0,0, -1,0,0,0, 0,0,1,0, 0,0,0,1]}])"_json;
  }
  const Scene scene = load(builder);
  CHECK(glm::distance(scene.positions[2], glm::vec3(9, 2, 0)) < 1e-6f);  // was (1, 1, 0); one rounding at 10
  CHECK(glm::distance(area_vector(scene), glm::vec3(0, 0, 2)) < 1e-5f);
}

TEST_CASE("However a node scales and mirrors, normals agree with the winding and tangents stay perpendicular",
          "[gltf]") {
  GltfBuilder builder = unit_square();
  json& attributes = builder.primitive()["attributes"];
  attributes["NORMAL"] = builder.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  attributes["TANGENT"] = builder.accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4);
  attributes["TEXCOORD_0"] = builder.accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, 2);
  builder.json["images"] =
      R"([{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP438DgwMjEzAIADNUByn7objcAAAAASUVORK5CYII="}])"_json;
  builder.json["textures"] = R"([{"source": 0}])"_json;
  builder.json["materials"] = R"([{"normalTexture": {"index": 0}}])"_json;
  builder.primitive()["material"] = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  for (int trial = 0; trial < 50; ++trial) {
    json matrix = json::array();
    for (int i = 0; i < 16; ++i) matrix.push_back(i % 4 == 3 ? (i == 15 ? 1.0 : 0.0) : uniform(random));
    builder.json["nodes"][0] = {{"mesh", 0}, {"matrix", matrix}};
    const Scene scene = load(builder);
    const glm::vec3 up_in_image(matrix[4], matrix[5], matrix[6]);  // where the mesh's +Y, the image's top, goes
    for (const glm::uvec3& triangle : scene.triangles) {
      // The front is what the file shows from +Z, seen in the mirror: cofactors over the determinant carry normals.
      const glm::vec3 geometric = glm::normalize(face(scene, triangle));
      for (int k = 0; k < 3; ++k) {
        const glm::vec3 normal = scene.normals[triangle[k]];
        const glm::vec4 tangent = scene.tangents[triangle[k]];
        CHECK(glm::dot(geometric, normal) ==
              Approx(1.0f).margin(1e-4));  // thin slivers lose digits in the cross product
        CHECK(glm::dot(glm::vec3(tangent), normal) == Approx(0.0f).margin(1e-5));
        CHECK(glm::dot(tangent.w * glm::cross(normal, glm::vec3(tangent)), up_in_image) > 0.0f);
      }
    }
  }
}

TEST_CASE("A mesh in two nodes gives two objects in draw order", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.json["nodes"] = R"([{"name": "b", "mesh": 0}, {"name": "a", "mesh": 0, "children": [0]}])"_json;
  builder.json.erase("scenes");
  const Scene scene = load(builder);
  REQUIRE(scene.objects.size() == 2);
  CHECK(scene.objects[0].name == "a");
  CHECK(scene.objects[1].name == "b");
  CHECK(scene.objects[1].first_triangle == 2);
  REQUIRE(scene.materials.size() == 1);
  CHECK(scene.materials[0].name == "default");
}

TEST_CASE("The scene that is shown is the one asked for, else the first, else all root nodes", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.json["nodes"] = R"([{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0}])"_json;
  builder.json["scenes"] = R"([{"nodes": [1]}, {"nodes": [0]}, {}])"_json;
  CHECK(load(builder).objects.at(0).name == "b");
  builder.json["scene"] = 1;
  CHECK(load(builder).objects.at(0).name == "a");
  builder.json["scene"] = 2;
  CHECK(load(builder).objects.empty());
  builder.json.erase("scene");
  builder.json.erase("scenes");
  CHECK(load(builder).objects.size() == 2);
}

TEST_CASE("Vertex arrays have entries for all vertices once one object needs them", "[gltf]") {
  GltfBuilder builder = unit_square();
  const size_t positions = builder.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0}, 3);
  const size_t colors = builder.accessor<float>({0, 0, 0, 0, 0, 0, 0, 0, 0}, 3);
  builder.mesh({{"POSITION", positions}, {"COLOR_0", colors}});
  builder.json["nodes"] = R"([{"mesh": 0}, {"mesh": 1}, {"mesh": 0}])"_json;
  builder.json["scenes"] = R"([{"nodes": [0, 1, 2]}])"_json;
  const Scene scene = load(builder);
  REQUIRE(scene.colors.size() == 15);
  CHECK(scene.colors[5] == glm::vec4(1));
  CHECK(scene.colors[6] == glm::vec4(0, 0, 0, 1));
  CHECK(scene.colors[14] == glm::vec4(1));
  CHECK(scene.uv[0].empty());
  CHECK(scene.tangents.empty());
}

TEST_CASE("Cameras stand where their node stands, without its scale", "[gltf]") {
  GltfBuilder builder;
  builder.json["cameras"] = R"([
    {"type": "perspective", "name": "lens", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 2}},
    {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 9}}])"_json;
  // Half a turn about Y: the camera looks along +Z.
  builder.json["nodes"] = R"([
    {"camera": 0, "translation": [1, 2, 3], "rotation": [0, 1, 0, 0], "scale": [5, 6, 7]},
    {"camera": 1, "name": "flat"}])"_json;
  const Scene scene = load(builder);
  REQUIRE(scene.cameras.size() == 2);
  CHECK(scene.triangles.empty());
  CHECK(scene.cameras[0].name == "lens");
  CHECK(scene.cameras[0].yfov == 0.5f);
  CHECK(scene.cameras[0].aspect == 2.0f);
  CHECK(scene.cameras[0].world_from_camera[3] == glm::vec4(1, 2, 3, 1));
  CHECK(scene.cameras[0].world_from_camera[2] == glm::vec4(0, 0, -1, 0));
  CHECK(scene.cameras[0].world_from_camera[0] == glm::vec4(-1, 0, 0, 0));
  CHECK(scene.cameras[1].name == "flat");
  CHECK(scene.cameras[1].orthographic);
  CHECK(scene.cameras[1].ymag == 2.0f);
  CHECK(scene.cameras[1].aspect == 1.5f);
}

TEST_CASE("Lights keep their radiometric values and stand where their node stands", "[gltf]") {
  GltfBuilder builder;
  builder.json["extensionsRequired"] = builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = R"([
    {"type": "point", "color": [1, 0.5, 0], "intensity": 10, "range": 5, "name": "bulb"},
    {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
    {"type": "directional", "intensity": 3}])"_json;
  builder.json["nodes"] = json::array();
  for (int i = 0; i < 3; ++i)  // a quarter turn about X: -Z becomes +Y
    builder.json["nodes"].push_back({{"translation", {1, 2, 3}},
                                     {"rotation", {0.70710678118, 0, 0, 0.70710678118}},
                                     {"scale", {2, 2, 2}},
                                     {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  voxref::LoadOptions options;
  options.light_scale = 2.0f;
  const Scene scene = load(builder, options);
  REQUIRE(scene.lights.size() == 3);
  CHECK(scene.lights[0].type == voxref::LightType::point);
  CHECK(scene.lights[0].name == "bulb");
  CHECK(scene.lights[0].intensity == glm::vec3(20, 10, 0));
  CHECK(scene.lights[0].position == glm::vec3(1, 2, 3));
  CHECK(scene.lights[1].type == voxref::LightType::spot);
  CHECK(scene.lights[1].cos_inner == std::cos(0.25f));
  CHECK(scene.lights[1].cos_outer == std::cos(0.5f));
  CHECK(glm::distance(scene.lights[1].direction, glm::vec3(0, 1, 0)) < 1e-6f);
  CHECK(scene.lights[2].type == voxref::LightType::directional);
  CHECK(scene.lights[2].intensity == glm::vec3(6));
  CHECK(warned(scene, "range of lights"));
}

TEST_CASE("Unknown extensions are refused when required and said once when not", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.json["extensionsUsed"] = {"EXT_made_up", "KHR_texture_transform", "EXT_made_up"};
  CHECK(load(builder).warnings == std::vector<std::string>{R"(extension "EXT_made_up" is ignored)"});
  builder.json["extensionsRequired"] = {"EXT_made_up"};
  CHECK_THROWS_AS(load(builder), voxref::Error);
}

TEST_CASE("A GLB file means the same as a .gltf file", "[gltf]") {
  const TemporaryFolder folder;
  const Scene text = voxref::load_gltf(folder.write("a.gltf", unit_square().text()));
  const Scene binary = voxref::load_gltf(folder.write("a.glb", unit_square().glb()));
  CHECK(text.positions == binary.positions);
  CHECK(text.triangles == binary.triangles);
  CHECK(text.sha256 != binary.sha256);
}

TEST_CASE("External files are found beside the file, and the hash covers them in order of use", "[gltf]") {
  const TemporaryFolder folder;
  GltfBuilder builder = unit_square();
  builder.json["buffers"] = {{{"byteLength", builder.bytes.size()}, {"uri", "my%20data.bin"}}};
  folder.write("my data.bin", builder.bytes);
  const std::string text = builder.text();
  const Scene scene = voxref::load_gltf(folder.write("a.gltf", text));
  CHECK(area_vector(scene) == glm::vec3(0, 0, 1));
  const std::string all = text + builder.bytes;
  CHECK(scene.sha256 == voxref::sha256(std::as_bytes(std::span(all))));
}

TEST_CASE("An external file may be longer than its buffer, and not shorter", "[gltf]") {
  const TemporaryFolder folder;
  GltfBuilder builder = unit_square();
  builder.json["buffers"] = {{{"byteLength", builder.bytes.size()}, {"uri", "data.bin"}}};
  const std::string text = builder.text();
  folder.write("data.bin", builder.bytes + "padding");
  CHECK(area_vector(voxref::load_gltf(folder.write("a.gltf", text))) == glm::vec3(0, 0, 1));
  folder.write("data.bin", builder.bytes.substr(1));
  CHECK_THROWS_AS(voxref::load_gltf(folder.write("a.gltf", text)), voxref::Error);
}

TEST_CASE("Computed tangents follow the texture as its transform turns it", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.primitive()["attributes"]["TEXCOORD_0"] = builder.accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, 2);
  builder.json["images"] =
      R"([{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP438DgwMjEzAIADNUByn7objcAAAAASUVORK5CYII="}])"_json;
  builder.json["textures"] = R"([{"source": 0}])"_json;
  builder.json["materials"] = R"([{"normalTexture": {"index": 0}}])"_json;
  builder.primitive()["material"] = 0;
  for (const glm::vec4& tangent : load(builder).tangents) CHECK(glm::vec3(tangent) == glm::vec3(1, 0, 0));
  // A quarter turn: (u, v) is looked up at (v, -u), so that what was along u is now along v, which points down.
  constexpr double quarter = 1.5707963267948966;
  builder.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = {{"rotation", quarter}};
  // cos of the rounded angle is 4e-8, not 0.
  for (const glm::vec4& tangent : load(builder).tangents)
    CHECK(glm::distance(glm::vec3(tangent), glm::vec3(0, -1, 0)) < 1e-6f);
}

TEST_CASE("Objects of named nodes and below them are dynamic", "[gltf]") {
  GltfBuilder builder = unit_square();
  builder.json["nodes"] = R"([{"name": "arm", "children": [1]}, {"mesh": 0}, {"mesh": 0}])"_json;
  builder.json["scenes"] = R"([{"nodes": [0, 2]}])"_json;
  voxref::LoadOptions options;
  options.dynamic = {"arm"};
  const Scene scene = load(builder, options);
  CHECK(scene.objects.at(0).dynamic);
  CHECK_FALSE(scene.objects.at(1).dynamic);
  options.dynamic = {"leg"};
  CHECK_THROWS_AS(load(builder, options), voxref::Error);
}
