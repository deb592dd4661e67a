#include "scene/gltf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x2.hpp>
#include <numeric>

#include "error.h"
#include "scene/tangents.h"

namespace voxref {
namespace {

constexpr uint64_t triangles_mode = 4, strip_mode = 5, fan_mode = 6;

bool is_integer(Component component) { return component != Component::float32 && component != Component::uint32; }
bool is_signed(Component component) { return component == Component::int8 || component == Component::int16; }

/// Whether glTF 2.0 (3.7.2.1), or KHR_mesh_quantization where the file uses it, allows the attribute this type.
bool allowed(const std::string& attribute, const GltfAccessor& accessor, bool quantized) {
  const Component component = accessor.component;
  const bool real = component == Component::float32;
  const bool signed_normalized = accessor.normalized && is_signed(component);
  const bool unsigned_normalized = accessor.normalized && is_integer(component) && !is_signed(component);
  if (accessor.matrix) return false;
  if (attribute == "POSITION") return accessor.components == 3 && (real || (quantized && is_integer(component)));
  if (attribute == "NORMAL") return accessor.components == 3 && (real || (quantized && signed_normalized));
  if (attribute == "TANGENT") return accessor.components == 4 && (real || (quantized && signed_normalized));
  if (attribute.starts_with("TEXCOORD_"))
    return accessor.components == 2 && (real || unsigned_normalized || (quantized && is_integer(component)));
  return (accessor.components == 3 || accessor.components == 4) && (real || unsigned_normalized);  // COLOR_0
}

std::optional<GltfPrimitive> read_primitive(GltfDocument& document, std::span<const GltfAccessor> accessors,
                                            const GltfValue& value) {
  GltfPrimitive primitive;
  primitive.place = value.place();
  primitive.mode = value.integer("mode", triangles_mode);
  primitive.material = value.index("material", document.count("materials"), "materials");
  primitive.indices = value.index("indices", accessors.size(), "accessors");
  if (primitive.mode > fan_mode) value.at("mode").fail("must be 0 to 6");
  if (!value.items("targets").empty()) warn_once(document.warnings, "morph targets are ignored");

  const bool quantized = document.uses("KHR_mesh_quantization");
  const GltfValue attributes = value.at("attributes");
  const auto attribute = [&](const std::string& name) {
    const auto index = attributes.index(name, accessors.size(), "accessors");
    if (index && !allowed(name, accessors[*index], quantized)) attributes.at(name).fail("has the wrong type");
    return index;
  };
  const auto positions = attribute("POSITION");
  primitive.normals = attribute("NORMAL");
  primitive.tangents = attribute("TANGENT");
  primitive.colors = attribute("COLOR_0");
  primitive.uv = {attribute("TEXCOORD_0"), attribute("TEXCOORD_1")};
  for (const std::string& name : attributes.keys()) {
    const uint32_t index = attributes.at(name).index(accessors.size(), "accessors");
    if (positions && accessors[index].count != accessors[*positions].count)
      attributes.at(name).fail(
          fmt::format("{} elements for {} positions", accessors[index].count, accessors[*positions].count));
  }
  if (primitive.indices) {
    const GltfAccessor& indices = accessors[*primitive.indices];
    if (indices.components != 1 || indices.component == Component::float32 || is_signed(indices.component) ||
        indices.normalized)
      value.at("indices").fail("must be SCALAR, unsigned and not normalized");
  }
  if (primitive.mode < triangles_mode) {
    warn_once(document.warnings, "points and lines are ignored");
    return std::nullopt;
  }
  if (!positions) {
    warn_once(document.warnings, "primitives without POSITION are ignored");
    return std::nullopt;
  }
  primitive.positions = *positions;
  const size_t count = accessors[primitive.indices.value_or(*positions)].count;
  if (primitive.mode == triangles_mode ? count % 3 != 0 : count < 3)
    value.fail(fmt::format("{} vertices do not make whole triangles", count));
  return primitive;
}

/// glTF 2.0, 3.7.2.1: the order of vertices in strips and fans that keeps all triangles counter-clockwise.
std::vector<glm::uvec3> assemble(uint64_t mode, std::span<const uint32_t> v) {
  std::vector<glm::uvec3> triangles(mode == triangles_mode ? v.size() / 3 : v.size() - 2);
  for (size_t i = 0; i < triangles.size(); ++i) {
    if (mode == triangles_mode)
      triangles[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
    else if (mode == strip_mode)
      triangles[i] = {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]};
    else
      triangles[i] = {v[i + 1], v[i + 2], v[0]};
  }
  return triangles;
}

std::vector<glm::uvec3> read_triangles(const GltfDocument& document, std::span<const GltfAccessor> accessors,
                                       const GltfPrimitive& primitive) {
  const size_t vertex_count = accessors[primitive.positions].count;
  std::vector<uint32_t> indices(vertex_count);
  if (primitive.indices) {
    indices = read_unsigned(document, accessors[*primitive.indices]);
    for (size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= vertex_count)
        throw Error(document.file, primitive.place + ".indices",
                    fmt::format("index {} is {}, there are {} vertices", i, indices[i], vertex_count));
  } else {
    std::iota(indices.begin(), indices.end(), 0u);
  }
  return assemble(primitive.mode, indices);
}

template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfDocument& document, std::span<const GltfAccessor> accessors,
                                             std::optional<uint32_t> index) {
  if (!index) return {};
  const std::vector<float> numbers = read_floats(document, accessors[*index]);
  const int stored = accessors[*index].components;
  std::vector<glm::vec<N, float>> vectors(accessors[*index].count, glm::vec<N, float>(1.0f));
  for (size_t i = 0; i < vectors.size(); ++i)
    for (int k = 0; k < std::min(N, stored); ++k) vectors[i][k] = numbers[i * stored + k];
  return vectors;
}

template <typename T>
void select(std::vector<T>& array, std::span<const uint32_t> source) {
  if (array.empty()) return;
  std::vector<T> selected(source.size());
  for (size_t i = 0; i < source.size(); ++i) selected[i] = array[source[i]];
  array = std::move(selected);
}

/// Makes vertex i what vertex source[i] was.
void select_vertices(Geometry& geometry, std::span<const uint32_t> source) {
  select(geometry.positions, source);
  select(geometry.normals, source);
  select(geometry.tangents, source);
  for (auto& uv : geometry.uv) select(uv, source);
  select(geometry.colors, source);
}

void drop_unused_vertices(Geometry& geometry) {
  std::vector<uint32_t> renumbered(geometry.positions.size(), 0);
  for (const glm::uvec3& triangle : geometry.triangles)
    for (int k = 0; k < 3; ++k) renumbered[triangle[k]] = 1;
  std::vector<uint32_t> source;
  for (uint32_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] == 0) continue;
    renumbered[i] = static_cast<uint32_t>(source.size());
    source.push_back(i);
  }
  if (source.size() == renumbered.size()) return;
  select_vertices(geometry, source);
  for (glm::uvec3& triangle : geometry.triangles)
    triangle = {renumbered[triangle[0]], renumbered[triangle[1]], renumbered[triangle[2]]};
}

/// Three vertices of its own for each triangle.
void unshare_vertices(Geometry& geometry) {
  std::vector<uint32_t> source;
  source.reserve(3 * geometry.triangles.size());
  for (glm::uvec3& triangle : geometry.triangles) {
    const auto first = static_cast<uint32_t>(source.size());
    source.insert(source.end(), {triangle[0], triangle[1], triangle[2]});
    triangle = {first, first + 1, first + 2};
  }
  select_vertices(geometry, source);
}

/// Which texture coordinates the material's textures look at.
std::array<bool, 2> uv_sets_of(const Material& m) {
  std::array<bool, 2> used = {false, false};
  for (const TextureBinding* binding : {&m.base_color_texture, &m.metallic_roughness_texture, &m.specular_texture,
                                        &m.specular_color_texture, &m.emission_texture, &m.normal_texture})
    if (*binding) used[binding->uv_set] = true;
  return used;
}

void finish_tangents(Geometry& geometry, const Material& material) {
  if (!material.normal_texture) {
    geometry.tangents.clear();
    return;
  }
  if (geometry.tangents.empty()) {
    // Along the texture as it is looked up, KHR_texture_transform included.
    std::vector<glm::vec2> uv = geometry.uv[material.normal_texture.uv_set];
    for (glm::vec2& at : uv) at = material.normal_texture.transform * glm::vec3(at, 1.0f);
    TangentSpace space = compute_tangents(geometry.positions, geometry.normals, uv, geometry.triangles);
    select_vertices(geometry, space.source);
    geometry.tangents = std::move(space.tangents);
    geometry.triangles = std::move(space.triangles);
  }
  for (size_t i = 0; i < geometry.tangents.size(); ++i) {
    const glm::vec4& tangent = geometry.tangents[i];
    geometry.tangents[i] =
        glm::vec4(perpendicular(geometry.normals[i], glm::vec3(tangent)), tangent.w < 0.0f ? -1.0f : 1.0f);
  }
}

}  // namespace

std::vector<std::vector<GltfPrimitive>> read_meshes(GltfDocument& document, std::span<const GltfAccessor> accessors) {
  std::vector<std::vector<GltfPrimitive>> meshes;
  for (const GltfValue& mesh : document.list("meshes")) {
    meshes.emplace_back();
    for (const GltfValue& value : mesh.at("primitives").items())
      if (auto primitive = read_primitive(document, accessors, value)) meshes.back().push_back(*std::move(primitive));
  }
  return meshes;
}

void repair_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                    std::vector<glm::vec3>& normals) {
  // In double, because squares of small and of large floats leave the range of float.
  std::vector<uint32_t> missing;
  for (uint32_t i = 0; i < normals.size(); ++i) {
    const glm::dvec3 normal(normals[i]);
    if (normal == glm::dvec3(0.0))
      missing.push_back(i);
    else
      normals[i] = glm::vec3(glm::normalize(normal));
  }
  if (missing.empty()) return;
  std::vector<glm::dvec3> faces(normals.size(), glm::dvec3(0.0));
  for (const glm::uvec3& triangle : triangles) {
    const glm::dvec3 a(positions[triangle[0]]), b(positions[triangle[1]]), c(positions[triangle[2]]);
    for (int k = 0; k < 3; ++k) faces[triangle[k]] += glm::cross(b - a, c - a);
  }
  for (uint32_t i : missing)
    normals[i] = faces[i] == glm::dvec3(0.0) ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(glm::normalize(faces[i]));
}

Geometry read_geometry(GltfDocument& document, std::span<const GltfAccessor> accessors, const GltfPrimitive& primitive,
                       const Material& material) {
  Geometry geometry;
  geometry.triangles = read_triangles(document, accessors, primitive);
  geometry.positions = read_vectors<3>(document, accessors, primitive.positions);
  geometry.normals = read_vectors<3>(document, accessors, primitive.normals);
  // Without normals the file's tangents have no meaning either (glTF 2.0, 3.7.2.1).
  if (primitive.normals) geometry.tangents = read_vectors<4>(document, accessors, primitive.tangents);
  const std::array<bool, 2> uv_used = uv_sets_of(material);
  for (int set = 0; set < 2; ++set) {
    if (!uv_used[set]) continue;
    geometry.uv[set] = read_vectors<2>(document, accessors, primitive.uv[set]);
    if (geometry.uv[set].empty()) {
      warn_once(document.warnings, "textures on primitives without texture coordinates are read at (0, 0)");
      geometry.uv[set].assign(geometry.positions.size(), glm::vec2(0.0f));
    }
  }
  geometry.colors = read_vectors<4>(document, accessors, primitive.colors);
  for (glm::vec4& color : geometry.colors) {
    const glm::vec4 clamped = glm::clamp(color, 0.0f, 1.0f);
    if (clamped != color) warn_once(document.warnings, "vertex colours outside 0 to 1 are clamped");
    color = clamped;
  }
  drop_unused_vertices(geometry);
  if (geometry.normals.empty()) {
    unshare_vertices(geometry);
    geometry.normals.assign(geometry.positions.size(), glm::vec3(0.0f));
  }
  repair_normals(geometry.positions, geometry.triangles, geometry.normals);
  finish_tangents(geometry, material);
  return geometry;
}

}  // namespace voxref
