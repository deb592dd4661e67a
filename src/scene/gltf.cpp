#include "scene/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>

#include "error.h"
#include "file.h"
#include "scene/gltf_animation.h"
#include "scene/gltf_material.h"
#include "scene/gltf_mesh.h"
#include "scene/tangents.h"

namespace voxref {
namespace {

/// A light in its own frame: at the origin, shining along -Z (KHR_lights_punctual).
Light read_light(GltfDocument& document, const GltfValue& value, float light_scale) {
  Light light;
  light.name = value.text("name");
  const std::string& type = value.at("type").text();
  if (type == "point")
    light.type = LightType::point;
  else if (type == "spot")
    light.type = LightType::spot;
  else if (type == "directional")
    light.type = LightType::directional;
  else
    value.at("type").fail("must be point, spot or directional");
  light.intensity = value.vector<3>("color", glm::vec3(1.0f), Range::unit()) *
                    value.number("intensity", 1.0f, Range::from(0.0)) * light_scale;
  if (!std::isfinite(glm::dot(light.intensity, glm::vec3(1.0f)))) value.fail("the intensity is too large");
  if (value.find("range")) {
    value.number("range", 1.0f, Range::positive());
    warn_once(document.warnings, "the range of lights is ignored: they fall off with the square of the distance");
  }
  if (light.type == LightType::spot) {
    const GltfValue spot = value.at("spot");
    constexpr double right_angle = 1.5707964, quarter = 0.78539816;  // rounded up: files round pi / 2 to float
    const float outer = spot.number("outerConeAngle", static_cast<float>(quarter), Range{0.0, right_angle});
    const float inner = spot.number("innerConeAngle", 0.0f, Range{0.0, right_angle});
    if (!(inner < outer)) spot.fail(fmt::format("innerConeAngle {:g} is not below outerConeAngle {:g}", inner, outer));
    light.cos_inner = std::cos(inner);
    light.cos_outer = std::cos(outer);
  }
  return light;
}

std::vector<Light> read_lights(GltfDocument& document, float light_scale) {
  std::vector<Light> lights;
  if (const auto extension = document.root().extension("KHR_lights_punctual"))
    for (const GltfValue& value : extension->items("lights"))
      lights.push_back(read_light(document, value, light_scale));
  return lights;
}

Camera read_camera(const GltfValue& value) {
  Camera camera;
  camera.name = value.text("name");
  const std::string& type = value.at("type").text();
  if (type == "perspective") {
    constexpr double largest_yfov = 3.1;  // just below pi, where the image plane would have no end
    const GltfValue lens = value.at("perspective");
    camera.yfov = static_cast<float>(lens.at("yfov").number(Range{Range::positive().low, largest_yfov}));
    camera.aspect = lens.number("aspectRatio", camera.aspect, Range::positive());
    camera.znear = lens.number("znear", camera.znear, Range::positive());
    camera.zfar = lens.number("zfar", camera.zfar, Range::positive());
  } else if (type == "orthographic") {
    const GltfValue lens = value.at("orthographic");
    camera.orthographic = true;
    camera.ymag = static_cast<float>(lens.at("ymag").number(Range::positive()));
    camera.aspect = static_cast<float>(lens.at("xmag").number(Range::positive())) / camera.ymag;
    camera.znear = lens.number("znear", camera.znear, Range::from(0.0));
    camera.zfar = lens.number("zfar", camera.zfar, Range::positive());
  } else {
    value.at("type").fail("must be perspective or orthographic");
  }
  return camera;
}

/// Position and axes of a camera or light, without the scale that its node may have.
/// @throws Error when the node leaves no direction to look along
glm::mat4 rigid(const GltfDocument& document, const GltfNode& node) {
  const glm::dvec3 back(node.world[2]), up(node.world[1]);
  const glm::dvec3 right = glm::cross(up, back);
  if (!(glm::length(right) > 0.0) || !std::isfinite(glm::length(right)))
    throw Error(document.file, node.place, "its transform leaves a camera or light without a direction");
  const glm::dvec3 z = glm::normalize(back), x = glm::normalize(right);
  return {glm::vec4(x, 0.0f), glm::vec4(glm::cross(z, x), 0.0f), glm::vec4(z, 0.0f),
          glm::vec4(glm::dvec3(node.world[3]), 1.0f)};
}

/// Puts a mesh's triangles into the world. A transform that mirrors turns triangles inside out, so that two vertices
/// are swapped (glTF 2.0, 3.7.4: the front of a mirrored node is clockwise).
Geometry transformed(const GltfDocument& document, const GltfNode& node, Geometry geometry) {
  const glm::dmat3 linear(node.world);
  const bool mirrors = glm::determinant(linear) < 0.0;
  const double side = mirrors ? -1.0 : 1.0;
  // det(M) M^-T, which also serves a transform that flattens: normals need no length.
  const glm::dmat3 normal_matrix = side * glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                                     glm::cross(linear[0], linear[1]));
  for (glm::vec3& position : geometry.positions) {
    position = glm::vec3(glm::dvec3(node.world * glm::dvec4(position, 1.0)));
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z))
      throw Error(document.file, node.place, "its transform takes a vertex out of the range of numbers");
  }
  for (glm::uvec3& triangle : geometry.triangles)
    if (mirrors) std::swap(triangle[1], triangle[2]);
  for (glm::vec3& normal : geometry.normals) {
    const glm::dvec3 turned = normal_matrix * glm::dvec3(normal);
    const double length = glm::length(turned);
    normal = length > 0.0 ? glm::vec3(turned / length) : glm::vec3(0.0f);
  }
  repair_normals(geometry.positions, geometry.triangles, geometry.normals);
  for (size_t i = 0; i < geometry.tangents.size(); ++i) {
    const glm::dvec3 turned = linear * glm::dvec3(geometry.tangents[i]);
    const glm::vec3 direction = glm::length(turned) > 0.0 ? glm::vec3(glm::normalize(turned)) : glm::vec3(0.0f);
    // The mirror turns cross(normal, tangent) round, but not the bitangent.
    geometry.tangents[i] =
        glm::vec4(perpendicular(geometry.normals[i], direction), geometry.tangents[i].w * static_cast<float>(side));
  }
  return geometry;
}

/// Appends to an array that stays empty as long as no object needs it, and gives earlier vertices `filler` then.
template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more, size_t vertices_before, const T& filler) {
  if (all.empty() && more.empty()) return;
  all.resize(vertices_before, filler);
  all.insert(all.end(), more.begin(), more.end());
}

void append_object(Scene& scene, const GltfDocument& document, const GltfNode& node, uint32_t material,
                   const Geometry& geometry) {
  const size_t before = scene.positions.size();
  constexpr size_t most = std::numeric_limits<uint32_t>::max() - 1;
  if (geometry.positions.size() > most - before || geometry.triangles.size() > most - scene.triangles.size())
    throw Error(document.file, node.place, "the scene has more vertices or triangles than 32-bit indices can count");
  scene.objects.push_back({node.name, static_cast<uint32_t>(scene.triangles.size()),
                           static_cast<uint32_t>(geometry.triangles.size()), material, node.dynamic});
  append(scene.positions, geometry.positions, before, {});
  append(scene.normals, geometry.normals, before, {});
  append(scene.tangents, geometry.tangents, before, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
  for (int set = 0; set < 2; ++set) append(scene.uv[set], geometry.uv[set], before, glm::vec2(0.0f));
  append(scene.colors, geometry.colors, before, glm::vec4(1.0f));
  for (const glm::uvec3& triangle : geometry.triangles)
    scene.triangles.push_back(triangle + glm::uvec3(static_cast<uint32_t>(before)));
  scene.triangle_materials.insert(scene.triangle_materials.end(), geometry.triangles.size(), material);
}

/// Objects that came after the last one with tangents, say, still owe their entries.
void pad_vertex_arrays(Scene& scene) {
  const size_t count = scene.positions.size();
  if (!scene.tangents.empty()) scene.tangents.resize(count, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
  for (auto& uv : scene.uv)
    if (!uv.empty()) uv.resize(count, glm::vec2(0.0f));
  if (!scene.colors.empty()) scene.colors.resize(count, glm::vec4(1.0f));
}

/// The objects of all nodes in draw order. Each primitive is read once, however many nodes show it.
void add_objects(Scene& scene, GltfDocument& document, std::span<const GltfAccessor> accessors,
                 const std::vector<std::vector<GltfPrimitive>>& meshes, const std::vector<GltfNode>& nodes,
                 std::span<const uint32_t> order) {
  std::map<uint32_t, std::vector<Geometry>> read;
  std::optional<uint32_t> fallback;  // glTF's default material, once a primitive names none
  const auto material_of = [&](const GltfPrimitive& primitive) {
    if (primitive.material) return *primitive.material;
    if (!fallback) {
      fallback = static_cast<uint32_t>(scene.materials.size());
      scene.materials.emplace_back().name = "default";
    }
    return *fallback;
  };
  for (uint32_t i : order) {
    const GltfNode& node = nodes[i];
    if (!node.mesh) continue;
    const std::vector<GltfPrimitive>& primitives = meshes[*node.mesh];
    std::vector<Geometry>& geometries = read[*node.mesh];
    if (geometries.empty())
      for (const GltfPrimitive& primitive : primitives)
        geometries.push_back(read_geometry(document, accessors, primitive, scene.materials[material_of(primitive)]));
    for (size_t k = 0; k < primitives.size(); ++k)
      append_object(scene, document, node, material_of(primitives[k]), transformed(document, node, geometries[k]));
  }
  pad_vertex_arrays(scene);
}

void add_lights_and_cameras(Scene& scene, const GltfDocument& document, std::span<const Light> lights,
                            std::span<const Camera> cameras, const std::vector<GltfNode>& nodes,
                            std::span<const uint32_t> order) {
  for (uint32_t i : order) {
    const GltfNode& node = nodes[i];
    if (node.light) {
      Light light = lights[*node.light];
      const glm::mat4 frame = rigid(document, node);
      light.position = glm::vec3(frame[3]);
      light.direction = -glm::vec3(frame[2]);
      if (light.name.empty()) light.name = node.name;
      scene.lights.push_back(std::move(light));
    }
    if (node.camera) {
      Camera camera = cameras[*node.camera];
      camera.world_from_camera = rigid(document, node);
      if (camera.name.empty()) camera.name = node.name;
      scene.cameras.push_back(std::move(camera));
    }
  }
}

void mark_dynamic(const GltfDocument& document, std::vector<GltfNode>& nodes, std::span<const std::string> names) {
  for (const std::string& name : names) {
    bool found = false;
    for (GltfNode& node : nodes)
      if (node.name == name) node.dynamic = found = true;
    if (!found) throw Error(document.file, "nodes", fmt::format("none is named '{}'", name));
  }
}

}  // namespace

Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options) {
  if (!(options.light_scale >= 0.0f) || !std::isfinite(options.light_scale))
    throw Error("light scale", "must be a number that is not negative");
  // First everything that the document says, then the bytes that it refers to: errors name what is wrong in the
  // document.
  GltfDocument document = open_gltf(file);
  Scene scene;
  scene.file = document.file;
  const std::vector<GltfAccessor> accessors = read_accessors(document);
  scene.materials = read_materials(document, options.light_scale);
  const std::vector<Light> lights = read_lights(document, options.light_scale);
  std::vector<Camera> cameras;
  for (const GltfValue& camera : document.list("cameras")) cameras.push_back(read_camera(camera));
  const std::vector<std::vector<GltfPrimitive>> meshes = read_meshes(document, accessors);
  std::vector<GltfNode> nodes = read_nodes(document);
  const std::vector<uint32_t> order = draw_order(document, nodes);
  mark_dynamic(document, nodes, options.dynamic);

  load_bytes(document);
  scene.sha256 = sha256(std::as_bytes(std::span(document.content)));
  animate(document, accessors, nodes, options.time);
  place_nodes(nodes, order);
  add_objects(scene, document, accessors, meshes, nodes, order);
  add_lights_and_cameras(scene, document, lights, cameras, nodes, order);
  scene.images = std::move(document.images);
  scene.warnings = std::move(document.warnings);
  return scene;
}

}  // namespace voxref
