#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "catch.h"
#include "error.h"
#include "scene/gltf.h"

namespace {

struct Asset {
  const char* file;
  size_t triangles;  ///< as assets/README.md counts them, times the nodes that show them
  size_t vertices;   ///< 0: the file has no normals, so that flat triangles share none
};

const Asset assets[] = {
    {"scenes/sponza.glb", 262249, 186981},
    {"scenes/sponza_banner.glb", 16896, 8970},
    {"scenes/conference.glb", 331179, 314678},
    {"scenes/conference_no_miniatures.glb", 124619, 95206},
    {"scenes/sibenik.glb", 75271, 85742},
    {"scenes/cornell_box_vctrenderer.glb", 36, 72},
    {"scenes/cornell_box.glb", 32, 64},
    {"objects/stanford_bunny.glb", 69451, 34834},
    {"objects/happy_buddha_100k.glb", 100000, 49951},
    {"objects/stanford_dragon_100k.glb", 100000, 50000},
    {"objects/utah_teapot.glb", 6320, 3392},
    {"loaders/Box.glb", 12, 24},
    {"loaders/Box_embedded.gltf", 12, 24},
    {"loaders/Box/Box.gltf", 12, 24},
    {"loaders/BoxInterleaved.glb", 12, 24},
    {"loaders/BoxTextured.glb", 12, 24},
    {"loaders/BoxTextured/BoxTextured.gltf", 12, 24},
    {"loaders/BoxTexturedNonPowerOfTwo.glb", 12, 24},
    {"loaders/BoxVertexColors.glb", 12, 24},
    {"loaders/SimpleSparseAccessor_embedded.gltf", 12, 0},
    {"loaders/TriangleWithoutIndices_embedded.gltf", 1, 0},
    {"loaders/SimpleMeshes_embedded.gltf", 2, 6},  // one triangle in two nodes
    {"loaders/Cameras_embedded.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_01.gltf", 0, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_04.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_05.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_06.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_11.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_12.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_13.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_14.gltf", 2, 0},
    {"loaders/PrimitiveMode/Mesh_PrimitiveMode_15.gltf", 2, 0},
    {"loaders/TextureSettingsTest.glb", 72, 144},
    {"loaders/TextureCoordinateTest_embedded.gltf", 10, 20},
    {"loaders/TextureTransformTest/TextureTransformTest.gltf", 24,
     0},  // the README's 18 in nine meshes; one in four nodes
    {"loaders/NormalTangentTest.glb", 7774, 3983},
    {"loaders/AlphaBlendModeTest.glb", 61, 137},
    {"loaders/TwoSidedPlane/TwoSidedPlane.gltf", 2, 0},
    {"loaders/EmissiveStrengthTest.glb", 90, 188},
    {"loaders/point_lights.glb", 120, 240},
    {"loaders/spot_lights.glb", 12, 24},
    {"loaders/CesiumMilkTruck.glb", 3624, 3564},  // the README's 2856, of which 768 (586 vertices), the wheels, twice
    {"loaders/DamagedHelmet.glb", 15452, 14556},
};

}  // namespace

TEST_CASE("All shared assets load with the triangles that their list counts", "[assets]") {
  if (!shared_file("assets")) VOXREF_SKIP("the shared assets are absent");
  for (const Asset& asset : assets) {
    INFO(asset.file);
    const auto file = shared_file(std::filesystem::path("assets") / asset.file);
    REQUIRE(file);
    const voxref::Scene scene = voxref::load_gltf(*file);
    CHECK_NOTHROW(voxref::validate(scene));
    CHECK(scene.triangles.size() == asset.triangles);
    CHECK(scene.positions.size() == (asset.vertices ? asset.vertices : 3 * asset.triangles));
    CHECK(scene.sha256.size() == 64);
  }
}

TEST_CASE("A file that requires Draco is refused by that name", "[assets]") {
  const auto file = shared_file("assets/loaders/Duck_Draco/Duck.gltf");
  if (!file) VOXREF_SKIP("the shared assets are absent");
  try {
    voxref::load_gltf(*file);
    FAIL("it loaded");
  } catch (const voxref::Error& error) {
    CHECK(std::string(error.what()).find("KHR_draco_mesh_compression") != std::string::npos);
  }
}

TEST_CASE("Sponza and the Cornell boxes have the bounds, lamps and textures of their list", "[assets]") {
  if (!shared_file("assets")) VOXREF_SKIP("the shared assets are absent");
  const voxref::Scene sponza = voxref::load_gltf(*shared_file("assets/scenes/sponza.glb"));
  const auto near = [](const glm::vec3& a, const glm::vec3& b) {
    return glm::all(glm::lessThan(glm::abs(a - b), glm::vec3(5.1e-4f)));  // the list rounds to three decimals
  };
  CHECK(near(sponza.bounds().min, {-19.209f, -1.264f, -11.828f}));
  CHECK(near(sponza.bounds().max, {17.999f, 14.294f, 11.054f}));
  CHECK(sponza.materials.size() == 24);
  CHECK(sponza.images.size() == 35);
  int masked = 0, mapped = 0;
  for (const voxref::Material& material : sponza.materials) {
    masked += material.alpha_mode == voxref::AlphaMode::mask;
    mapped += static_cast<bool>(material.normal_texture);
  }
  CHECK(masked == 3);
  CHECK(mapped == 11);

  const voxref::Scene cornell = voxref::load_gltf(*shared_file("assets/scenes/cornell_box.glb"));
  glm::vec3 brightest(0.0f);
  for (const voxref::Material& material : cornell.materials) brightest = glm::max(brightest, material.emission);
  CHECK(glm::distance(brightest, glm::vec3(17, 12, 4)) < 1e-5f);  // 12/17 and 4/17 are rounded in the file
}

TEST_CASE("The lights of the shared light samples are there", "[assets]") {
  if (!shared_file("assets")) VOXREF_SKIP("the shared assets are absent");
  const voxref::Scene points = voxref::load_gltf(*shared_file("assets/loaders/point_lights.glb"));
  REQUIRE(points.lights.size() == 4);
  for (const voxref::Light& light : points.lights) CHECK(light.type == voxref::LightType::point);
  const voxref::Scene spots = voxref::load_gltf(*shared_file("assets/loaders/spot_lights.glb"));
  REQUIRE(spots.lights.size() == 2);
  for (const voxref::Light& light : spots.lights) CHECK(light.type == voxref::LightType::spot);
}
