// The files of scenes/, and the catalog that they are written from.
#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <set>
#include <string>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "make_scenes/builders.h"
#include "make_scenes/catalog.h"
#include "make_scenes/gltf_writer.h"
#include "scene/gltf.h"

using voxref::Scene;
using voxref::SceneEntry;

namespace {

const std::filesystem::path folder = std::filesystem::path(VOXREF_SOURCE_DIR) / "scenes";

}  // namespace

TEST_CASE("Every committed scene is byte for byte what the builders give", "[scenes]") {
  std::set<std::string> expected;
  for (const SceneEntry& entry : voxref::scene_catalog()) {
    INFO(entry.file);
    expected.insert(entry.file);
    const std::string bytes = voxref::glb(voxref::build_scene(entry), voxref::description(entry));
    CHECK((bytes == voxref::read_file(folder / entry.file)));
  }
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder))
    if (file.path().extension() == ".glb")
      CHECK(expected.count(std::filesystem::relative(file.path(), folder).generic_string()) == 1);
}

TEST_CASE("The table of scenes/README.md is the catalog", "[scenes]") {
  const std::string readme = voxref::read_file(folder / "README.md");
  for (const SceneEntry& entry : voxref::scene_catalog()) {
    INFO(entry.file);
    CHECK(readme.find(voxref::table_row(entry) + "\n") != std::string::npos);
  }
}

TEST_CASE("A scene file loads as the scene that was written", "[scenes]") {
  for (const SceneEntry& entry : voxref::scene_catalog()) {
    INFO(entry.file);
    const Scene made = voxref::build_scene(entry), loaded = voxref::load_gltf(folder / entry.file);
    CHECK(loaded.warnings.empty());
    CHECK((loaded.positions == made.positions));
    CHECK((loaded.triangles == made.triangles));
    CHECK((loaded.triangle_materials == made.triangle_materials));
    REQUIRE(loaded.normals.size() == made.normals.size());
    float normal_error = 0.0f;
    for (size_t i = 0; i < made.normals.size(); ++i)
      normal_error = std::max(normal_error, glm::distance(loaded.normals[i], made.normals[i]));
    CHECK(normal_error < 1e-6f);  // the loader normalizes again, in float

    REQUIRE(loaded.materials.size() >= made.materials.size());
    for (size_t i = 0; i < made.materials.size(); ++i) {
      const voxref::Material &a = loaded.materials[i], &b = made.materials[i];
      CHECK((a.name == b.name && a.base_color == b.base_color && a.metallic == b.metallic));
      CHECK((a.roughness == b.roughness && a.specular == b.specular && a.double_sided == b.double_sided));
      CHECK(glm::distance(a.emission, b.emission) <= 1e-6f * glm::length(b.emission));  // factor times strength
    }
    REQUIRE(loaded.lights.size() == made.lights.size());
    for (size_t i = 0; i < made.lights.size(); ++i) {
      const voxref::Light &a = loaded.lights[i], &b = made.lights[i];
      CHECK((a.name == b.name && a.type == b.type && a.position == b.position));
      CHECK(glm::distance(a.intensity, b.intensity) <= 1e-6f * glm::length(b.intensity));  // colour times intensity
      if (b.type == voxref::LightType::directional)
        CHECK(glm::distance(a.direction, b.direction) < 1e-6f);  // through a float quaternion
    }
    REQUIRE(loaded.cameras.size() == made.cameras.size());
    for (size_t i = 0; i < made.cameras.size(); ++i) {
      const voxref::Camera &a = loaded.cameras[i], &b = made.cameras[i];
      CHECK((a.name == b.name && a.yfov == b.yfov && a.aspect == b.aspect));
      for (int column = 0; column < 4; ++column)
        CHECK(glm::distance(a.world_from_camera[column], b.world_from_camera[column]) < 1e-6f);
    }
  }
}

TEST_CASE("Scaling keeps radiance: lengths grow by the factor, intensities by its square", "[scenes]") {
  const Scene scene = voxref::plane_test(), large = voxref::scaled(scene, 10.0f);
  CHECK(large.bounds().max.y == Approx(10.0f * scene.bounds().max.y));
  CHECK(large.lights[0].intensity == scene.lights[0].intensity);  // directional: irradiance
  const Scene room = voxref::thin_wall(0.1f), tiny = voxref::scaled(room, 0.01f);
  CHECK(glm::distance(tiny.lights[0].intensity, 1e-4f * room.lights[0].intensity) < 1e-10f);
  const glm::vec3 corner(1.0f, 1.0f, 0.5f);
  const voxref::Illumination before = voxref::illuminate(room.lights[0], corner);
  CHECK(voxref::illuminate(tiny.lights[0], 0.01f * corner).irradiance.x == Approx(before.irradiance.x));
  CHECK(glm::distance(glm::vec3(tiny.cameras[0].world_from_camera[3]),
                      0.01f * glm::vec3(room.cameras[0].world_from_camera[3])) < 1e-8f);
}

TEST_CASE("Parameters out of range are refused, given ones are named in the file", "[scenes]") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(voxref::furnace(1.0f), voxref::Error);
  CHECK_THROWS_AS(voxref::furnace(nan), voxref::Error);
  CHECK_THROWS_AS(voxref::sphere_furnace(0.5f, 9), voxref::Error);
  CHECK_THROWS_AS(voxref::thin_wall(0.0f), voxref::Error);
  CHECK_THROWS_AS(voxref::thin_wall(nan), voxref::Error);
  CHECK_THROWS_AS(voxref::single_object("teacup"), voxref::Error);
  CHECK_THROWS_AS(voxref::scaled(voxref::furnace(0.5f), 0.0f), voxref::Error);
  voxref::SceneParameters parameters;
  parameters.thickness = 0.005f;
  for (const SceneEntry& entry : voxref::scene_catalog())
    if (entry.name() == "thin_wall") {
      CHECK(voxref::description(entry, parameters) == voxref::description(entry) + " Made with thickness 0.005.");
      CHECK(voxref::build_scene(entry, parameters).positions != voxref::build_scene(entry).positions);
    }
}
