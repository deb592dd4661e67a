#include <algorithm>
#include <array>

#include <utility>

#include "error.h"
#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"
#include "make_scenes/teapot.h"

namespace voxref {
namespace {

/// Moved along y so that its lowest point is at y = 0.
Mesh standing(Mesh mesh) {
  float lowest = mesh.positions.front().y;
  for (const glm::vec3& p : mesh.positions) lowest = std::min(lowest, p.y);
  return moved(std::move(mesh), {0.0f, -lowest, 0.0f});
}

Mesh object_mesh(const std::string& name, const ObjectDetail& detail) {
  if (name == "icosahedron") return scaled(icosahedron(), 0.5f);
  if (name == "cube") return box(glm::vec3(-0.4f), glm::vec3(0.4f));
  if (name == "sphere") return scaled(icosphere(detail.subdivisions), 0.5f);
  if (name == "cone") return cone(0.45f, 1.0f, detail.segments);
  if (name == "torus") return torus(0.35f, 0.15f, detail.segments, std::max(3, detail.segments / 2));
  if (name == "plane") return rotated(plane(0.9f), 60.0f, {1.0f, 0.0f, 0.0f});
  if (name == "cylinder") return cylinder(0.35f, 0.9f, detail.segments);
  if (name == "teapot") return scaled(teapot(detail.teapot), 0.2f);
  throw Error("object", "no object is named " + name);
}

Light daylight() { return sun("sun", {-0.5f, -1.0f, -0.7f}, glm::vec3(3.0f)); }

}  // namespace

const std::vector<std::string>& object_names() {
  static const std::vector<std::string> names = {"icosahedron", "cube",  "sphere",   "cone",
                                                 "torus",       "plane", "cylinder", "teapot"};
  return names;
}

Scene single_object(const std::string& name, const ObjectDetail& detail) {
  const Mesh mesh = standing(object_mesh(name, detail));
  Scene scene;
  add_object(scene, name, mesh, add_material(scene, lambertian("white", glm::vec3(0.8f))));
  scene.lights.push_back(daylight());
  scene.cameras.push_back(camera("front", {0.9f, 1.2f, 2.4f}, {0.0f, 0.4f, 0.0f}, 35.0f, 1.0f));
  return scene;
}

Scene primitives(const ObjectDetail& detail) {
  const std::array<glm::vec3, 8> colors = {{{0.75f, 0.3f, 0.25f},
                                            {0.3f, 0.55f, 0.75f},
                                            {0.8f, 0.7f, 0.3f},
                                            {0.35f, 0.65f, 0.35f},
                                            {0.6f, 0.4f, 0.7f},
                                            {0.75f, 0.75f, 0.75f},
                                            {0.8f, 0.5f, 0.3f},
                                            {0.7f, 0.72f, 0.75f}}};
  Scene scene;
  add_object(scene, "ground", plane(8.0f), add_material(scene, lambertian("ground", glm::vec3(0.6f))));
  for (size_t i = 0; i < object_names().size(); ++i) {
    const std::string& name = object_names()[i];
    // 2 mm above the ground: no face lies in its plane.
    const glm::vec3 place(1.4f * static_cast<float>(i % 4) - 2.1f, 0.002f, i < 4 ? -0.8f : 0.8f);
    const uint32_t material = add_material(scene, lambertian(name, colors[i]));
    add_object(scene, name, moved(standing(object_mesh(name, detail)), place), material);
  }
  scene.lights.push_back(daylight());
  scene.cameras.push_back(camera("front", {0.0f, 3.4f, 6.0f}, {0.0f, 0.3f, 0.0f}, 30.0f, 16.0f / 9.0f));
  return scene;
}

}  // namespace voxref
