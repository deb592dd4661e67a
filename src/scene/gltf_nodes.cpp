#include "scene/gltf_nodes.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "error.h"

namespace voxref {
namespace {

/// How far from unit length a quaternion may be: what 8-bit components, the coarsest that glTF knows, can be off by.
constexpr double quaternion_slack = 0.01;

void read_transform(const GltfValue& value, GltfNode& node) {
  if (const auto matrix = value.find("matrix")) {
    for (const char* key : {"translation", "rotation", "scale"})
      if (value.find(key)) value.fail(fmt::format("has both matrix and {}", key));
    const std::vector<double> m = matrix->numbers(16);
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) matrix->fail("the last row must be 0, 0, 0, 1");
    node.matrix.emplace();
    for (int i = 0; i < 16; ++i) (*node.matrix)[i / 4][i % 4] = m[i];
    return;
  }
  if (const auto translation = value.find("translation")) {
    const std::vector<double> t = translation->numbers(3);
    node.translation = {t[0], t[1], t[2]};
  }
  if (const auto rotation = value.find("rotation")) {
    const std::vector<double> q = rotation->numbers(4);
    node.rotation = glm::dquat(q[3], q[0], q[1], q[2]);
    const double length = glm::length(node.rotation);
    if (std::abs(length - 1.0) > quaternion_slack)
      rotation->fail(fmt::format("the quaternion's length is {:.4g}, not 1", length));
    node.rotation = glm::normalize(node.rotation);
  }
  if (const auto scale = value.find("scale")) {
    const std::vector<double> s = scale->numbers(3);
    node.scale = {s[0], s[1], s[2]};
  }
}

std::vector<uint32_t> scene_roots(const GltfDocument& document, const std::vector<int64_t>& parents) {
  std::vector<uint32_t> roots;
  const std::vector<GltfValue> scenes = document.list("scenes");
  const auto chosen = document.root().index("scene", scenes.size(), "scenes");
  if (scenes.empty()) {
    for (uint32_t i = 0; i < parents.size(); ++i)
      if (parents[i] < 0) roots.push_back(i);
    return roots;
  }
  std::vector<bool> listed(parents.size(), false);
  for (const GltfValue& entry : scenes[chosen.value_or(0)].items("nodes")) {
    const uint32_t root = entry.index(parents.size(), "nodes");
    if (parents[root] >= 0) entry.fail(fmt::format("nodes[{}] is a child of nodes[{}]", root, parents[root]));
    if (listed[root]) entry.fail(fmt::format("nodes[{}] is listed twice", root));
    listed[root] = true;
    roots.push_back(root);
  }
  return roots;
}

/// Depth first, parents before children. Not recursive: files may nest deeper than the stack.
std::vector<uint32_t> descend(const std::vector<GltfNode>& nodes, const std::vector<uint32_t>& roots) {
  std::vector<uint32_t> order;
  std::vector<uint32_t> stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const uint32_t node = stack.back();
    stack.pop_back();
    order.push_back(node);
    stack.insert(stack.end(), nodes[node].children.rbegin(), nodes[node].children.rend());
  }
  return order;
}

}  // namespace

glm::dmat4 GltfNode::local() const {
  if (matrix) return *matrix;
  return glm::scale(glm::translate(glm::dmat4(1.0), translation) * glm::mat4_cast(rotation), scale);
}

std::vector<GltfNode> read_nodes(GltfDocument& document) {
  const std::vector<GltfValue> values = document.list("nodes");
  const size_t mesh_count = document.count("meshes"), camera_count = document.count("cameras");
  const auto lights = document.root().extension("KHR_lights_punctual");
  const size_t light_count = lights ? lights->items("lights").size() : 0;
  std::vector<GltfNode> nodes;
  for (const GltfValue& value : values) {
    GltfNode node;
    node.name = value.text("name");
    node.place = value.place();
    node.mesh = value.index("mesh", mesh_count, "meshes");
    node.camera = value.index("camera", camera_count, "cameras");
    if (const auto light = value.extension("KHR_lights_punctual"))
      node.light = light->at("light").index(light_count, "extensions.KHR_lights_punctual.lights");
    for (const GltfValue& child : value.items("children")) node.children.push_back(child.index(values.size(), "nodes"));
    if (value.index("skin", document.count("skins"), "skins"))
      warn_once(document.warnings, "skins are ignored: meshes keep the shape that the file stores");
    read_transform(value, node);
    nodes.push_back(std::move(node));
  }
  return nodes;
}

std::vector<uint32_t> draw_order(const GltfDocument& document, const std::vector<GltfNode>& nodes) {
  std::vector<int64_t> parents(nodes.size(), -1);
  for (uint32_t i = 0; i < nodes.size(); ++i)
    for (size_t c = 0; c < nodes[i].children.size(); ++c) {
      const uint32_t child = nodes[i].children[c];
      if (parents[child] >= 0)
        throw Error(document.file, fmt::format("nodes[{}].children[{}]", i, c),
                    fmt::format("nodes[{}] is a child of nodes[{}] already", child, parents[child]));
      parents[child] = i;
    }
  // With one parent each, what cannot be reached from a node without parents hangs on a cycle.
  std::vector<uint32_t> all_roots;
  for (uint32_t i = 0; i < nodes.size(); ++i)
    if (parents[i] < 0) all_roots.push_back(i);
  std::vector<bool> reached(nodes.size(), false);
  for (uint32_t node : descend(nodes, all_roots)) reached[node] = true;
  for (uint32_t i = 0; i < nodes.size(); ++i)
    if (!reached[i]) throw Error(document.file, nodes[i].place, "is its own ancestor, or hangs on a node that is");
  return descend(nodes, scene_roots(document, parents));
}

void place_nodes(std::vector<GltfNode>& nodes, std::span<const uint32_t> order) {
  for (uint32_t i : order) nodes[i].world = glm::dmat4(1.0);
  for (uint32_t i : order) {
    GltfNode& node = nodes[i];
    node.world = node.world * node.local();  // until here `world` is the parent's
    for (uint32_t child : node.children) {
      nodes[child].world = node.world;
      nodes[child].dynamic = nodes[child].dynamic || node.dynamic;
    }
  }
}

}  // namespace voxref
