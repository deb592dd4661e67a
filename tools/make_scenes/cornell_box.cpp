#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <span>
#include <string>

#include "make_scenes/assemble.h"
#include "make_scenes/builders.h"
#include "make_scenes/shapes.h"
#include "make_scenes/spectrum.h"

// Corners in millimetres, in the order in which Cornell publishes them: counter-clockwise seen from the room.
namespace voxref {
namespace {

using Corners = std::array<glm::dvec3, 4>;

constexpr Corners floor_corners = {{{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}};
constexpr Corners ceiling_corners = {{{556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}}};
constexpr Corners back_corners = {{{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}}};
constexpr Corners right_corners = {{{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}}};
constexpr Corners left_corners = {{{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}}};
constexpr Corners lamp_corners = {{{343, 548.8, 227}, {343, 548.8, 332}, {213, 548.8, 332}, {213, 548.8, 227}}};

constexpr std::array<Corners, 5> short_block = {{
    {{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
    {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
    {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
    {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
    {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}},
}};
constexpr std::array<Corners, 5> tall_block = {{
    {{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
    {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
    {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
    {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
    {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}},
}};

glm::vec3 metres(const glm::dvec3& millimetres) { return 0.001 * millimetres; }

Mesh face(const Corners& c) { return quad(metres(c[0]), metres(c[1]), metres(c[2]), metres(c[3])); }

/// Top and sides: the bottom lies in the floor's plane and is left out.
Mesh block(std::span<const Corners> faces) {
  Mesh mesh;
  for (const Corners& corners : faces) append(mesh, face(corners));
  return mesh;
}

/// The ceiling around the lamp: four trapezoids that share the corners of both.
Mesh ceiling_with_hole() {
  Mesh mesh;
  for (size_t i = 0; i < 4; ++i) {
    const size_t next = (i + 1) % 4;
    append(mesh, face({ceiling_corners[i], ceiling_corners[next], lamp_corners[next], lamp_corners[i]}));
  }
  return mesh;
}

/// Walls, floor, ceiling and light; the white material is the first.
Scene empty_box(CornellLight light) {
  const CornellColors colors = cornell_colors();
  Scene scene;
  const uint32_t white = add_material(scene, lambertian("white", colors.white));
  const uint32_t red = add_material(scene, lambertian("red", colors.red));
  const uint32_t green = add_material(scene, lambertian("green", colors.green));

  add_object(scene, "floor", face(floor_corners), white);
  add_object(scene, "ceiling", light == CornellLight::area ? ceiling_with_hole() : face(ceiling_corners), white);
  add_object(scene, "back_wall", face(back_corners), white);
  add_object(scene, "right_wall", face(right_corners), green);
  add_object(scene, "left_wall", face(left_corners), red);

  if (light == CornellLight::area) {
    const Mesh lamp = face(lamp_corners);
    add_object(scene, "lamp", lamp, add_material(scene, emitter("lamp", colors.lamp_albedo, colors.lamp_radiance)));
  } else {
    // The lamp's intensity straight down is radiance x area. At 0.1 m the spot that it burns into the ceiling spans
    // many voxels at any resolution in use.
    const auto lamp_area = static_cast<float>(area(face(lamp_corners)));
    const glm::vec3 below = metres(0.5 * (lamp_corners[0] + lamp_corners[2])) - glm::vec3(0.0f, 0.1f, 0.0f);
    scene.lights.push_back(point_light("lamp", below, lamp_area * colors.lamp_radiance));
  }
  // Published: at (278, 273, -800), looking along +Z, focal length 35 mm, film 25 mm x 25 mm.
  const auto yfov = static_cast<float>(glm::degrees(2.0 * std::atan(0.5 * 25.0 / 35.0)));
  scene.cameras.push_back(camera("cornell", metres({278, 273, -800}), metres({278, 273, 0}), yfov, 1.0f));
  return scene;
}

}  // namespace

Scene cornell_box(CornellLight light, bool blocks) {
  Scene scene = empty_box(light);
  if (blocks) {
    add_object(scene, "short_block", block(short_block), 0);
    add_object(scene, "tall_block", block(tall_block), 0);
  }
  return scene;
}

Scene glossy_spheres() {
  Scene scene = empty_box(CornellLight::area);
  struct Row {
    const char* name;
    glm::vec3 color;
    float metallic;
  };
  // A red dielectric, whose lobe is white; half dielectric, half metal; gold's reflectance at normal incidence.
  const std::array<Row, 3> rows = {{{"plastic", {0.6f, 0.1f, 0.1f}, 0.0f},
                                    {"lacquer", {0.3f, 0.4f, 0.8f}, 0.5f},
                                    {"gold", {1.0f, 0.766f, 0.336f}, 1.0f}}};
  const std::array<float, 3> roughness = {0.1f, 0.4f, 0.8f};
  const Mesh sphere = scaled(icosphere(3), 0.07f);
  for (size_t row = 0; row < rows.size(); ++row)
    for (size_t column = 0; column < roughness.size(); ++column) {
      Material material;
      material.name = std::string(rows[row].name) + "_" + std::to_string(column);
      material.base_color = glm::vec4(rows[row].color, 1.0f);
      material.metallic = rows[row].metallic;
      material.roughness = roughness[column];
      // +X is to the camera's left.
      const glm::vec3 center(0.44f - 0.165f * static_cast<float>(column), 0.075f + 0.16f * static_cast<float>(row),
                             0.3f);
      add_object(scene, material.name, moved(sphere, center), add_material(scene, material));
    }
  return scene;
}

}  // namespace voxref
