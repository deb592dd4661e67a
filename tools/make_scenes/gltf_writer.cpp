#include "make_scenes/gltf_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "error.h"
#include "file.h"

namespace voxref {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF's binary chunk is little-endian");

/// The double whose shortest text is the float's: 0.1f becomes 0.1, not 0.10000000149011612.
double number(float value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double result = 0.0;
  std::from_chars(text.data(), end, result);
  return result + 0.0;  // no negative zeros
}

Json numbers(std::span<const float> values) {
  Json array = Json::array();
  for (const float value : values) array.push_back(number(value));
  return array;
}

Json numbers(const glm::vec3& v) { return numbers(std::array{v.x, v.y, v.z}); }

/// The quaternion (x, y, z, w) that turns -Z into `direction` (unit) the short way: cross(-Z, d) and 1 + dot(-Z, d),
/// normalized; half a turn about Y where they are opposite.
std::array<float, 4> rotation_from_minus_z(const glm::dvec3& direction) {
  const glm::dvec3 minus_z(0.0, 0.0, -1.0), axis = glm::cross(minus_z, direction);
  const double w = 1.0 + glm::dot(minus_z, direction), length = std::sqrt(glm::dot(axis, axis) + w * w);
  if (length < 1e-6) return {0.0f, 1.0f, 0.0f, 0.0f};
  return {float(axis.x / length), float(axis.y / length), float(axis.z / length), float(w / length)};
}

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

/// The JSON and the binary chunk as they grow.
class GlbWriter {
 public:
  GlbWriter(const Scene& scene, const std::string& description) : scene_(scene) {
    root_["asset"] = {
        {"version", "2.0"}, {"generator", "voxref make_scenes"}, {"extras", {{"description", description}}}};
    root_["scene"] = 0;
    root_["scenes"] = Json::array({{{"nodes", Json::array()}}});
    for (const Material& material : scene.materials) add_material(material);
    for (const Object& object : scene.objects) add_object(object);
    for (const Camera& camera : scene.cameras) add_camera(camera);
    for (const Light& light : scene.lights) add_light(light);
    if (!lights_.empty()) {
      root_["extensions"]["KHR_lights_punctual"]["lights"] = lights_;
      extensions_.insert("KHR_lights_punctual");
    }
    if (!extensions_.empty()) root_["extensionsUsed"] = extensions_;
    if (!binary_.empty()) root_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  }

  std::string bytes() const {
    const auto padded = [](std::string chunk, char filler) {
      chunk.resize((chunk.size() + 3) / 4 * 4, filler);
      return chunk;
    };
    const std::string json = padded(root_.dump(), ' '), binary = padded(binary_, '\0');
    std::string file = "glTF";
    const auto append_number = [&](size_t value) {
      const auto number = static_cast<uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    append_number(2);  // the container's version
    append_number(12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size()));
    append_number(json.size());
    file += "JSON" + json;
    if (binary.empty()) return file;
    append_number(binary.size());
    file.append("BIN\0", 4).append(binary);
    return file;
  }

 private:
  void add_node(Json node) {
    root_["scenes"][0]["nodes"].push_back(root_["nodes"].size());
    root_["nodes"].push_back(std::move(node));
  }

  void add_material(const Material& m) {
    if (m.workflow != Workflow::metallic_roughness || m.base_color_texture || m.metallic_roughness_texture ||
        m.specular_texture || m.specular_color_texture || m.emission_texture || m.normal_texture ||
        m.alpha_mode != AlphaMode::opaque || m.specular_color != glm::vec3(1.0f))
      throw Error("material " + m.name, "only untextured opaque metallic-roughness materials can be written");
    Json json = {{"name", m.name}};
    json["pbrMetallicRoughness"] = {
        {"baseColorFactor", numbers(std::array{m.base_color.r, m.base_color.g, m.base_color.b, m.base_color.a})},
        {"metallicFactor", number(m.metallic)},
        {"roughnessFactor", number(m.roughness)}};
    if (m.emissive()) {
      // The factor lies in [0, 1]; what is above 1 is the strength.
      const float strength = std::max(1.0f, largest(m.emission));
      json["emissiveFactor"] = numbers(m.emission / strength);
      if (strength > 1.0f) {
        json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", number(strength)}};
        extensions_.insert("KHR_materials_emissive_strength");
      }
    }
    if (m.specular != 1.0f) {
      json["extensions"]["KHR_materials_specular"] = {{"specularFactor", number(m.specular)}};
      extensions_.insert("KHR_materials_specular");
    }
    if (m.double_sided) json["doubleSided"] = true;
    root_["materials"].push_back(std::move(json));
  }

  /// Appends elements to the binary chunk and describes them. @returns the accessor's index
  template <typename T>
  size_t add_accessor(std::span<const T> elements, int target, int component_type, size_t count, const char* type) {
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    root_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", elements.size_bytes()}, {"target", target}});
    binary_.append(reinterpret_cast<const char*>(elements.data()), elements.size_bytes());
    root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                  {"componentType", component_type},
                                  {"count", count},
                                  {"type", type}});
    return root_["accessors"].size() - 1;
  }

  size_t add_vectors(std::span<const glm::vec3> vectors) {
    constexpr int array_buffer = 34962, component_float = 5126;
    return add_accessor(vectors, array_buffer, component_float, vectors.size(), "VEC3");
  }

  size_t add_indices(std::span<const uint32_t> indices, size_t vertex_count) {
    constexpr int element_array_buffer = 34963, unsigned_short = 5123, unsigned_int = 5125;
    if (vertex_count > 65535)  // index 65535 is reserved
      return add_accessor(indices, element_array_buffer, unsigned_int, indices.size(), "SCALAR");
    const std::vector<uint16_t> shorts(indices.begin(), indices.end());
    return add_accessor(std::span(shorts), element_array_buffer, unsigned_short, shorts.size(), "SCALAR");
  }

  /// The object's triangles with the range of vertices that they use.
  void add_object(const Object& object) {
    if (object.triangle_count == 0) return;  // glTF knows no empty accessor
    std::vector<uint32_t> indices;
    for (uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t)
      for (glm::length_t corner = 0; corner < 3; ++corner) indices.push_back(scene_.triangles[t][corner]);
    const auto [lowest, highest] = std::minmax_element(indices.begin(), indices.end());
    const uint32_t first = *lowest, count = *highest - first + 1;
    for (uint32_t& index : indices) index -= first;

    const auto positions = std::span(scene_.positions).subspan(first, count);
    const size_t position_accessor = add_vectors(positions);
    Bounds bounds;
    for (const glm::vec3& p : positions) bounds.add(p);
    root_["accessors"].back()["min"] = numbers(bounds.min);
    root_["accessors"].back()["max"] = numbers(bounds.max);
    const size_t normal_accessor = add_vectors(std::span(scene_.normals).subspan(first, count));
    const size_t index_accessor = add_indices(indices, count);

    const Json primitive = {{"attributes", {{"POSITION", position_accessor}, {"NORMAL", normal_accessor}}},
                            {"indices", index_accessor},
                            {"material", object.material}};
    root_["meshes"].push_back({{"name", object.name}, {"primitives", Json::array({primitive})}});
    add_node({{"name", object.name}, {"mesh", root_["meshes"].size() - 1}});
  }

  void add_camera(const Camera& camera) {
    if (camera.orthographic) throw Error("camera " + camera.name, "only perspective cameras can be written");
    constexpr float near_plane = 0.01f;  // glTF wants one; both renderers ignore it
    root_["cameras"].push_back(
        {{"name", camera.name},
         {"type", "perspective"},
         {"perspective",
          {{"aspectRatio", number(camera.aspect)}, {"yfov", number(camera.yfov)}, {"znear", number(near_plane)}}}});
    const std::span matrix(&camera.world_from_camera[0][0], 16);
    add_node({{"name", camera.name}, {"matrix", numbers(matrix)}, {"camera", root_["cameras"].size() - 1}});
  }

  void add_light(const Light& light) {
    if (light.type == LightType::spot) throw Error("light " + light.name, "spot lights cannot be written");
    const bool point = light.type == LightType::point;
    // The colour lies in [0, 1], so its largest channel is the intensity.
    const float intensity = largest(light.intensity);
    lights_.push_back({{"name", light.name},
                       {"type", point ? "point" : "directional"},
                       {"color", numbers(intensity > 0.0f ? light.intensity / intensity : glm::vec3(1.0f))},
                       {"intensity", number(intensity)}});
    Json node = {{"name", light.name}};
    if (point) {
      node["translation"] = numbers(light.position);
    } else {
      node["rotation"] = numbers(rotation_from_minus_z(light.direction));
    }
    node["extensions"]["KHR_lights_punctual"]["light"] = lights_.size() - 1;
    add_node(std::move(node));
  }

  const Scene& scene_;
  Json root_;
  Json lights_ = Json::array();
  std::set<std::string> extensions_;
  std::string binary_;
};

}  // namespace

std::string glb(const Scene& scene, const std::string& description) {
  validate(scene);
  return GlbWriter(scene, description).bytes();
}

void write_glb(const std::filesystem::path& file, const Scene& scene, const std::string& description) {
  const std::string bytes = glb(scene, description);
  write_atomically(file, std::as_bytes(std::span(bytes)));
}

}  // namespace voxref
