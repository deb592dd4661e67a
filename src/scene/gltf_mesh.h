#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/material.h"

namespace voxref {

/// What a glTF primitive of triangles refers to: accessors of the right type and of equal count.
struct GltfPrimitive {
  std::string place;
  uint64_t mode = 4;  ///< 4 triangles, 5 strip, 6 fan
  uint32_t positions = 0;
  std::optional<uint32_t> indices, normals, tangents, colors, material;
  std::array<std::optional<uint32_t>, 2> uv;
};

/// The triangles of each mesh's primitives, in order; points and lines are left out with a warning.
/// @throws Error FILE: PLACE: what
std::vector<std::vector<GltfPrimitive>> read_meshes(GltfDocument& document, std::span<const GltfAccessor> accessors);

/// A primitive's triangles in the space of its mesh. Vertex arrays are empty or have one entry per vertex.
struct Geometry {
  std::vector<glm::vec3> positions, normals;  ///< normals are unit and always present
  std::vector<glm::vec4> tangents;            ///< as in Scene; present where the material has a normal map
  std::vector<glm::vec2> uv[2];               ///< present where the material's textures need them
  std::vector<glm::vec4> colors;              ///< in [0,1]
  std::vector<glm::uvec3> triangles;          ///< counter-clockwise from the front
};

/// Reads a primitive whose material is `material`. Vertices that no triangle uses are dropped; without NORMAL the
/// triangles are flat and share no vertices. The document's bytes must be loaded. @throws Error FILE: PLACE: what
Geometry read_geometry(GltfDocument& document, std::span<const GltfAccessor> accessors, const GltfPrimitive& primitive,
                       const Material& material);

/// Makes normals unit. One that has no direction takes that of its triangles, the mean weighted with their area, or +Y
/// where they have no area either.
void repair_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                    std::vector<glm::vec3>& normals);

}  // namespace voxref
