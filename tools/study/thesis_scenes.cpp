#include "study/thesis_scenes.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"
#include "scene/gltf.h"
#include "study/study_scenes.h"

namespace voxref {

namespace {

/// A material whose published specular cone has this half-angle, 90 degrees x (1 - glossiness).
Material glossy(const std::string& name, float degrees) {
  Material material = lambertian(name, glm::vec3(0.5f));
  material.workflow = Workflow::specular_glossiness;
  material.specular_color = glm::vec3(0.5f);
  material.glossiness = 1.0f - degrees / 90.0f;
  return material;
}

Mesh mesh_of(const Scene& scene) { return {scene.positions, scene.normals, scene.triangles}; }

/// Scaled to a height and stood on a point.
Mesh stood(Mesh mesh, float height, const glm::vec3& foot) {
  Bounds bounds;
  for (const glm::vec3& p : mesh.positions) bounds.add(p);
  const float factor = height / bounds.extent().y;
  const glm::vec3 own_foot(bounds.center().x, bounds.min.y, bounds.center().z);
  return moved(scaled(moved(std::move(mesh), -own_foot), factor), foot);
}

/// Objects have neither texture coordinates nor tangents nor colours; where the scene has them they get blank ones.
void pad_vertices(Scene& scene) {
  const size_t count = scene.positions.size();
  if (!scene.tangents.empty()) scene.tangents.resize(count, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
  for (auto& uv : scene.uv)
    if (!uv.empty()) uv.resize(count);
  if (!scene.colors.empty()) scene.colors.resize(count, glm::vec4(1.0f));
}

void add_dynamic(Scene& scene, const std::string& name, const Mesh& mesh, float degrees) {
  add_object(scene, name, mesh, add_material(scene, glossy(name, degrees)));
  scene.objects.back().dynamic = true;
  pad_vertices(scene);
}

/// The three objects side by side on the floor in front of the camera.
void add_objects(StudyScene& scene, const std::filesystem::path& assets, float height, const glm::vec3& middle,
                 const glm::vec3& side, std::vector<std::string>& skipped) {
  struct Statue {
    const char* file;
    float degrees;
  };
  constexpr std::array statues = {Statue{"happy_buddha_100k", 45.0f}, Statue{"stanford_dragon_100k", 27.0f},
                                  Statue{"stanford_bunny", 9.0f}};
  float place = -1.0f;
  for (const Statue& statue : statues) {
    const std::filesystem::path file = assets / "assets/objects" / (std::string(statue.file) + ".glb");
    if (!assets.empty() && std::filesystem::exists(file))
      add_dynamic(scene.scene, statue.file, stood(mesh_of(load_gltf(file)), height, middle + place * side),
                  statue.degrees);
    else if (std::find(skipped.begin(), skipped.end(), statue.file) == skipped.end())
      skipped.emplace_back(statue.file);
    place += 1.0f;
  }
}

void set_light(Scene& scene, ThesisLight light, const glm::vec3& lamp, float intensity) {
  if (light == ThesisLight::sun)
    scene.lights = {sun("sun", {0.25f, -1.0f, 0.15f}, glm::vec3(1.0f))};
  else
    scene.lights = {point_light("lamp", lamp, glm::vec3(intensity))};
}

}  // namespace

std::vector<StudyScene> thesis_scenes(const StudyRequest& request, ThesisLight light,
                                      std::vector<std::string>& skipped) {
  std::vector<StudyScene> scenes;
  StudyScene box = cornell_point_scene();
  box.name = "cornell_box";
  set_light(box.scene, light, {0.278f, 0.45f, 0.28f}, 1.0f);
  add_objects(box, request.assets, 0.12f, {0.28f, 0.0f, 0.1f}, {0.15f, 0.0f, 0.0f}, skipped);
  scenes.push_back(std::move(box));
  struct Place {
    const char* name;
    float height;
    glm::vec3 middle, side, lamp;
  };
  constexpr std::array places = {
      Place{"sibenik", 1.8f, {-9.0f, -15.3f, 0.0f}, {0.0f, 0.0f, 2.0f}, {-4.0f, -8.0f, 0.0f}},
      Place{"conference", 0.5f, {0.0f, 0.0f, -1.0f}, {0.6f, 0.0f, 0.0f}, {1.0f, 2.2f, -0.8f}},
      Place{"sponza", 2.0f, {-6.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}, {0.0f, 5.0f, 0.0f}},
  };
  for (const Place& place : places) {
    auto scene = public_scene(place.name, request.assets, light == ThesisLight::sun);
    if (!scene) {
      if (std::find(skipped.begin(), skipped.end(), place.name) == skipped.end()) skipped.emplace_back(place.name);
      continue;
    }
    set_light(scene->scene, light, place.lamp, 1.0f);
    add_objects(*scene, request.assets, place.height, place.middle, place.side, skipped);
    scenes.push_back(std::move(*scene));
  }
  return scenes;
}

StudyScene glowing_teapot() {
  StudyScene result{"glowing_teapot", {}, {}};
  Scene& scene = result.scene;
  const uint32_t grey = add_material(scene, lambertian("grey", glm::vec3(0.7f)));
  const uint32_t glow = add_material(scene, emitter("teapot", glm::vec3(0.0f), glm::vec3(1.0f)));
  add_object(scene, "floor", plane(4.0f), grey);
  add_object(scene, "left", box({-1.2f, 0.0f, -0.4f}, {-0.8f, 0.8f, 0.4f}), grey);
  add_object(scene, "right", box({0.8f, 0.0f, -0.4f}, {1.2f, 0.8f, 0.4f}), grey);
  add_object(scene, "teapot", mesh_of(single_object("teapot")), glow);
  scene.cameras.push_back(camera("front", {0.0f, 1.6f, 3.2f}, {0.0f, 0.3f, 0.0f}, 45.0f, 16.0f / 9.0f));
  result.view.camera = scene.cameras[0];
  return result;
}

StudyScene specular_ball(float degrees) {
  StudyScene result{"specular_ball", cornell_box(CornellLight::point, /*blocks=*/false), {}};
  add_object(result.scene, "ball", moved(scaled(icosphere(4), 0.15f), {0.278f, 0.16f, 0.28f}),
             add_material(result.scene, glossy("ball", degrees)));
  result.view.camera = result.scene.cameras.at(0);
  return result;
}

}  // namespace voxref
