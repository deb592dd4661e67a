#include "make_scenes/catalog.h"

#include <fmt/format.h>

#include <cmath>

#include "error.h"
#include "make_scenes/builders.h"

namespace voxref {
namespace {

ObjectDetail detail(const SceneParameters& p) {
  const ObjectDetail usual;
  return {p.subdivisions.value_or(usual.subdivisions), p.segments.value_or(usual.segments),
          p.divisions.value_or(usual.teapot)};
}

SceneEntry object_entry(const std::string& name, const std::string& sentence) {
  return {"objects/" + name + ".glb", sentence, "",
          [name](const SceneParameters& p) { return single_object(name, detail(p)); }};
}

std::vector<SceneEntry> cornell_entries() {
  const std::string box = "Cornell's measured box";
  return {
      {"cornell_box.glb", box + " and blocks, lit by the measured lamp, an emissive quad in a hole of the ceiling.", "",
       [](const SceneParameters&) { return cornell_box(CornellLight::area); }},
      {"cornell_box_point.glb",
       box + " and blocks under a point light 0.1 m below the lamp's place, as intense as the lamp straight down.", "",
       [](const SceneParameters&) { return cornell_box(CornellLight::point); }},
      {"cornell_box_empty.glb", box + " without blocks under the same point light.", "",
       [](const SceneParameters&) { return cornell_box(CornellLight::point, false); }},
      {"glossy_spheres.glb",
       "Nine GGX spheres in Cornell's box: rows of plastic, lacquer (half metallic) and gold from the floor up, "
       "roughness "
       "0.1, 0.4 and 0.8 from left to right.",
       "", [](const SceneParameters&) { return glossy_spheres(); }},
  };
}

std::vector<SceneEntry> closed_form_entries() {
  return {
      {"furnace_50.glb", "A closed cube of side 2 seen from inside, emission 1 and albedo 0.5 everywhere.",
       "Radiance 1 / (1 - 0.5) = 2 in every direction.",
       [](const SceneParameters& p) { return furnace(p.albedo.value_or(0.5f)); }},
      {"furnace_90.glb", "A closed cube of side 2 seen from inside, emission 1 and albedo 0.9 everywhere.",
       "Radiance 1 / (1 - 0.9) = 10 in every direction.",
       [](const SceneParameters& p) { return furnace(p.albedo.value_or(0.9f)); }},
      {"sphere_furnace.glb",
       "A closed sphere of albedo 0.5, seen from its centre, where a point light of 1 W/sr sits; flat facets with the "
       "unit "
       "sphere's area, so that the mean irradiance is exact.",
       "Irradiance 1 W/m^2 directly (of 20,480 facets, each one's mean within 0.007 %), 2 in all; radiance 0.5 / (pi "
       "(1 - 0.5)) = "
       "0.31831.",
       [](const SceneParameters& p) { return sphere_furnace(p.albedo.value_or(0.5f), p.subdivisions.value_or(5)); }},
      {"point_light_over_plane.glb", "A plane y = 0 of albedo 0.5 under a point light of 1 W/sr at (0, 1, 0).",
       "Irradiance I cos / d^2 = (1 + x^2 + z^2)^(-3/2); radiance 0.5 / pi of that.",
       [](const SceneParameters&) { return point_light_over_plane(); }},
      {"rectangle_luminaire.glb",
       "A plane y = 0 of albedo 0.5 under a black square of side 1 at height 1 that emits radiance 1 downwards.",
       "Irradiance by Lambert's formula, 4 sqrt(1/5) atan(sqrt(1/5)) = 0.752275 below the square's centre; radiance "
       "0.5 / "
       "pi of that.",
       [](const SceneParameters&) { return rectangle_luminaire(); }},
  };
}

std::vector<SceneEntry> room_entries() {
  return {
      {"red_green_wall.glb",
       "A white floor cut by two sheets 2 mm apart, red to the left, green to the right, a point light on either side.",
       "Left of them indirect light has no green, right of them no red.",
       [](const SceneParameters&) { return red_green_wall(); }},
      {"thin_wall.glb", "A closed white room cut in two by a wall 20 mm thick, a point light in one half.",
       "The other half, seen by the camera `dark`, is black.",
       [](const SceneParameters& p) { return thin_wall(p.thickness.value_or(0.02f)); }},
      {"light_box.glb",
       "A closed white interior of albedo 0.8 with edges so smooth that nothing occludes, under a low point light of 1 "
       "W/sr.",
       "Irradiance averaged over its area A is 4 pi / (A (1 - 0.8)), but for what interpolated normals change.",
       [](const SceneParameters&) { return light_box(); }},
      {"plane_test.glb", "A slab with a thin tall box in one corner, under a directional light.", "",
       [](const SceneParameters&) { return plane_test(); }},
  };
}

std::vector<SceneEntry> object_entries() {
  return {
      {"primitives.glb", "The seven primitives and the teapot on a plane, under a directional light.", "",
       [](const SceneParameters& p) { return primitives(detail(p)); }},
      object_entry("icosahedron", "An icosahedron, flat shaded."),
      object_entry("cube", "A cube of side 0.8."),
      object_entry("sphere", "A sphere of radius 0.5: an icosahedron cut three times."),
      object_entry("cone", "A cone of radius 0.45 and height 1."),
      object_entry("torus", "A torus of radii 0.35 and 0.15."),
      object_entry("plane", "A square of side 0.9, tilted by 60 degrees; one face."),
      object_entry("cylinder", "A cylinder of radius 0.35 and height 0.9."),
      object_entry("teapot", "The Utah teapot, tessellated from its 32 published patches, a fifth of its size."),
  };
}

}  // namespace

const std::vector<SceneEntry>& scene_catalog() {
  static const std::vector<SceneEntry> catalog = [] {
    std::vector<SceneEntry> all;
    for (const auto& part : {cornell_entries(), closed_form_entries(), room_entries(), object_entries()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return catalog;
}

Scene build_scene(const SceneEntry& entry, const SceneParameters& parameters) {
  return scaled(entry.build(parameters), parameters.scale);
}

Scene scaled(Scene scene, float factor) {
  if (!(std::isfinite(factor) && factor > 0.0f)) throw Error("scale", "must be finite and above 0");
  for (glm::vec3& p : scene.positions) p *= factor;
  for (Camera& camera : scene.cameras) {
    for (glm::length_t axis = 0; axis < 3; ++axis) camera.world_from_camera[3][axis] *= factor;
    camera.ymag *= factor;
  }
  for (Light& light : scene.lights) {
    light.position *= factor;
    if (light.type != LightType::directional) light.intensity *= factor * factor;
  }
  return scene;
}

std::string description(const SceneEntry& entry, const SceneParameters& p) {
  std::string varied;
  const auto note = [&](const char* name, const auto& value) {
    if (value) varied += fmt::format("{}{} {}", varied.empty() ? " Made with " : ", ", name, *value);
  };
  note("subdivisions", p.subdivisions);
  note("segments", p.segments);
  note("divisions", p.divisions);
  note("thickness", p.thickness);
  note("albedo", p.albedo);
  note("scale", p.scale == 1.0f ? std::optional<float>() : p.scale);
  return entry.sentence + (entry.answer.empty() ? "" : " ") + entry.answer + varied + (varied.empty() ? "" : ".");
}

std::string table_row(const SceneEntry& entry) {
  const std::string count = std::to_string(build_scene(entry).triangles.size());
  return "| `" + entry.file + "` | " + entry.sentence + " | " + count + " | " + entry.answer + " |";
}

}  // namespace voxref
