#include "study/thesis_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "cone/cone_set.h"
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

/// Adds an object to a scene that may have texture coordinates, tangents or colours: its own are blank.
void add_blank(Scene& scene, const std::string& name, const Mesh& mesh, const Material& material) {
  add_object(scene, name, mesh, add_material(scene, material));
  const size_t count = scene.positions.size();
  if (!scene.tangents.empty()) scene.tangents.resize(count, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
  for (auto& uv : scene.uv)
    if (!uv.empty()) uv.resize(count);
  if (!scene.colors.empty()) scene.colors.resize(count, glm::vec4(1.0f));
}

/// A dynamic object of all scenes.
struct Statue {
  const char* file;
  float degrees;  ///< half-angle of its specular cone
  std::optional<Mesh> mesh{};
};

std::vector<Statue> load_statues(const std::filesystem::path& assets, std::vector<std::string>& skipped) {
  std::vector<Statue> statues = {
      {"happy_buddha_100k", 45.0f}, {"stanford_dragon_100k", 27.0f}, {"stanford_bunny", 9.0f}};
  for (Statue& statue : statues) {
    const std::filesystem::path file = assets / "assets/objects" / (std::string(statue.file) + ".glb");
    if (!assets.empty() && std::filesystem::exists(file))
      statue.mesh = mesh_of(load_gltf(file));
    else
      skipped.push_back(std::string(statue.file) + ": not in VOXREF_ASSETS");
  }
  return statues;
}

/// Where the statues stand, side by side on the floor in front of the camera; metres.
struct Place {
  const char* scene;
  float height;
  glm::vec3 middle, side;
};
constexpr std::array places = {
    Place{"cornell_box", 0.12f, {0.28f, 0.0f, 0.1f}, {0.15f, 0.0f, 0.0f}},
    Place{"cornell_box_empty", 0.12f, {0.28f, 0.0f, 0.1f}, {0.15f, 0.0f, 0.0f}},
    Place{"sibenik", 1.8f, {-9.0f, -15.3f, 0.0f}, {0.0f, 0.0f, 2.0f}},
    Place{"conference", 0.5f, {0.0f, 0.0f, -1.0f}, {0.6f, 0.0f, 0.0f}},
    Place{"sponza", 2.0f, {-6.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}},
    Place{"light_box", 0.3f, {0.0f, -0.75f, -0.45f}, {0.5f, 0.0f, 0.0f}},
    Place{"plane_test", 0.6f, {-0.2f, 0.0f, -0.2f}, {0.8f, 0.0f, 0.0f}},
};

void add_statues(StudyScene& scene, const std::vector<Statue>& statues) {
  const auto place = std::find_if(places.begin(), places.end(), [&](const Place& p) { return scene.name == p.scene; });
  float position = -1.0f;
  for (const Statue& statue : statues) {
    if (statue.mesh) {
      add_blank(scene.scene, statue.file, stood(*statue.mesh, place->height, place->middle + position * place->side),
                glossy(statue.file, statue.degrees));
      scene.scene.objects.back().dynamic = true;
    }
    position += 1.0f;
  }
}

}  // namespace

namespace {

/// One of the project's own, which need no file.
std::optional<StudyScene> own_scene(const std::string& name) {
  if (name == "cornell_box" || name == "cornell_box_empty")
    return seen_by_first_camera(name, cornell_box(CornellLight::point, /*blocks=*/name == "cornell_box"));
  if (name == "light_box") return light_box_scene();
  if (name == "plane_test") return plane_test_scene();
  return std::nullopt;
}

/// Where the one lamp hangs; metres.
glm::vec3 lamp_of(const std::string& name) {
  if (name.starts_with("cornell_box")) return cornell_point_scene().scene.lights.at(0).position;
  if (name == "light_box") return light_box_scene().scene.lights.at(0).position;
  if (name == "plane_test") return {0.5f, 2.2f, 0.8f};  // before the pillar, so that its shadow is seen
  return standpoint(name).lamp;
}

}  // namespace

std::vector<StudyScene> thesis_scenes(const StudyRequest& request, std::vector<std::string>& skipped) {
  const std::vector<Statue> statues = load_statues(request.assets, skipped);
  std::vector<StudyScene> scenes;
  for (const Place& place : places) {
    std::optional<StudyScene> scene = own_scene(place.scene);
    const std::string name = place.scene;
    if (!scene && request.quick)
      skipped.push_back(name + ": too large for --quick");
    else if (!scene && !(scene = public_scene(name, request.assets, /*sun=*/true)))
      skipped.push_back(name + ": not in VOXREF_ASSETS");
    if (!scene) continue;
    add_statues(*scene, statues);
    scenes.push_back(std::move(*scene));
  }
  return scenes;
}

void light_scenes(std::vector<StudyScene>& scenes, ThesisLight light) {
  constexpr float published_unit = 1.0f;  // its lights fade with no distance, and bytes hold no more
  for (StudyScene& scene : scenes)
    scene.scene.lights = {light == ThesisLight::sun
                              ? study_sun(published_unit)
                              : point_light("lamp", lamp_of(scene.name), glm::vec3(published_unit))};
}

namespace {

StudyScene glowing_teapot() {
  Scene scene;
  const uint32_t grey = add_material(scene, lambertian("grey", glm::vec3(0.7f)));
  const uint32_t glow = add_material(scene, emitter("teapot", glm::vec3(0.0f), glm::vec3(1.0f)));
  add_object(scene, "floor", plane(4.0f), grey);
  add_object(scene, "left", box({-1.2f, 0.0f, -0.4f}, {-0.8f, 0.8f, 0.4f}), grey);
  add_object(scene, "right", box({0.8f, 0.0f, -0.4f}, {1.2f, 0.8f, 0.4f}), grey);
  add_object(scene, "teapot", mesh_of(single_object("teapot")), glow);
  scene.cameras.push_back(camera("front", {0.0f, 1.6f, 3.2f}, {0.0f, 0.3f, 0.0f}, 45.0f, 16.0f / 9.0f));
  return seen_by_first_camera("teapot", std::move(scene));
}

void add_glowing_ball(Scene& scene, const glm::vec3& center, float radius, const glm::vec3& color) {
  add_blank(scene, "ball", moved(scaled(icosphere(3), radius), center), emitter("ball", glm::vec3(0.0f), color));
}

/// Three balls side by side in place of all lights.
Scene with_colored_balls(Scene scene, const glm::vec3& middle, const glm::vec3& side, float radius, float radiance) {
  scene.lights.clear();
  for (int i = 0; i < 3; ++i) {
    glm::vec3 color(0.0f);
    color[i] = radiance;
    add_glowing_ball(scene, middle + float(i - 1) * side, radius, color);
  }
  return scene;
}

StudyScene two_emitters() {
  Scene scene;
  const uint32_t white = add_material(scene, lambertian("white", glm::vec3(0.7f)));
  add_object(scene, "floor", plane(4.0f), white);
  add_object(scene, "block", box({-0.2f, 0.0f, -0.6f}, {0.2f, 0.9f, 0.6f}), white);
  add_glowing_ball(scene, {-1.2f, 0.5f, 0.0f}, 0.25f, {3.0f, 0.3f, 0.3f});
  add_glowing_ball(scene, {1.2f, 0.5f, 0.0f}, 0.25f, {0.3f, 0.3f, 3.0f});
  scene.cameras.push_back(camera("above", {0.0f, 3.0f, 3.0f}, {0.0f, 0.2f, 0.0f}, 45.0f, 16.0f / 9.0f));
  return seen_by_first_camera("two_emitters", std::move(scene));
}

}  // namespace

std::vector<StudyScene> glowing_scenes(const std::vector<StudyScene>& scenes) {
  std::vector<StudyScene> glowing = {glowing_teapot()};
  glowing.push_back(seen_by_first_camera(
      "colored_cornell_box", with_colored_balls(cornell_box(CornellLight::point, false), {0.28f, 0.15f, 0.28f},
                                                {0.16f, 0.0f, 0.0f}, 0.05f, 3.0f)));
  for (const StudyScene& scene : scenes)
    if (scene.name == "sponza") {
      glowing.push_back(scene);
      glowing.back().name = "colored_sponza";
      glowing.back().scene =
          with_colored_balls(std::move(glowing.back().scene), {-2.0f, 2.0f, 0.0f}, {4.0f, 0.0f, 0.0f}, 0.7f, 20.0f);
    }
  glowing.push_back(two_emitters());
  return glowing;
}

float rendered_half_angle(const Material& material) {
  const float in_byte = std::nearbyint(255.0f * material.glossiness) * (1.0f / 255.0f);  // to even, as the G-buffer
  return glm::degrees(std::atan(published_specular_tan_half_angle(in_byte)));
}

StudyScene specular_ball(float degrees) {
  Scene box = cornell_box(CornellLight::point, /*blocks=*/false);
  add_object(box, "ball", moved(scaled(icosphere(4), 0.15f), {0.278f, 0.16f, 0.28f}),
             add_material(box, glossy("ball", degrees)));
  return seen_by_first_camera("specular_ball", std::move(box));
}

}  // namespace voxref
