#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_document.h"

namespace voxref {

/// A node of the glTF hierarchy. Transforms are double: chains of them reach vertices with one rounding.
struct GltfNode {
  std::string name;
  std::string place;
  std::optional<uint32_t> mesh, camera, light;
  std::vector<uint32_t> children;

  std::optional<glm::dmat4> matrix;  ///< instead of the three below
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit
  glm::dvec3 scale{1.0};

  bool dynamic = false;   ///< itself or, after place_nodes, an ancestor
  glm::dmat4 world{1.0};  ///< world from node, after place_nodes

  glm::dmat4 local() const;  ///< parent from node
};

/// All nodes, each transform checked, every reference inside its list. @throws Error FILE: PLACE: what
std::vector<GltfNode> read_nodes(GltfDocument& document);

/// The nodes of the file's scene (`scene`, else the first, else all root nodes), parents before children, children in
/// the order of the file: the draw order. @throws Error when a node has two parents or is its own ancestor
std::vector<uint32_t> draw_order(const GltfDocument& document, const std::vector<GltfNode>& nodes);

/// Computes `world`, and hands `dynamic` down, for the nodes in `order`.
void place_nodes(std::vector<GltfNode>& nodes, std::span<const uint32_t> order);

}  // namespace voxref
