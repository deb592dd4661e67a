#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/texture.h"

namespace voxref {

struct Bounds {
  glm::vec3 min{std::numeric_limits<float>::infinity()};
  glm::vec3 max{-std::numeric_limits<float>::infinity()};

  bool empty() const { return !(min.x <= max.x); }
  void add(const glm::vec3& point);
  glm::vec3 extent() const { return empty() ? glm::vec3(0.0f) : max - min; }
  glm::vec3 center() const { return empty() ? glm::vec3(0.0f) : 0.5f * (min + max); }
};

/// A primitive of a glTF mesh in a node: consecutive triangles with one material.
struct Object {
  std::string name;  ///< the node's
  uint32_t first_triangle = 0, triangle_count = 0;
  uint32_t material = 0;
  bool dynamic = false;  ///< moved by an animation of the file, or named by the user
};

/// What is lit: world-space triangles in draw order (node order, then index order), flattened over instances.
/// Vertex arrays that no object needs are empty; the others have one entry per vertex.
struct Scene {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit; always present
  std::vector<glm::vec4>
      tangents;  ///< unit xyz, w = +-1: bitangent = w * cross(normal, tangent.xyz); only for normal maps
  std::vector<glm::vec2> uv[2];
  std::vector<glm::vec4> colors;  ///< linear, multiplies the base colour

  std::vector<glm::uvec3> triangles;         ///< counter-clockwise seen from the front
  std::vector<uint32_t> triangle_materials;  ///< one per triangle
  std::vector<Object> objects;               ///< in draw order; their triangle ranges cover all triangles

  std::vector<Material> materials;
  std::vector<TextureImage> images;
  std::vector<Light> lights;
  std::vector<Camera> cameras;

  std::string file;                   ///< where it came from; empty: made in memory
  std::string sha256;                 ///< of the file's and all its external files' bytes, in order of use
  std::vector<std::string> warnings;  ///< optional features that were ignored, one line each

  Bounds bounds() const;
  bool has_emission() const;
};

/// Throws out what later stages rely on: index ranges, array lengths, finite positions, material references.
/// The loader's output always passes; scenes made in memory are checked before use. @throws Error naming the place
void validate(const Scene& scene);

}  // namespace voxref
