#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "temporary_folder.h"

inline std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

inline std::string word(uint32_t value) { return {reinterpret_cast<const char*>(&value), sizeof(value)}; }

/// Builds small glTF documents: arrays become accessors in one buffer; everything else is edited in `json`.
struct GltfBuilder {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::string bytes;

  /// Appends values as a buffer view of their own. @returns its index
  template <typename T>
  size_t view(const std::vector<T>& values) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return json["bufferViews"].size() - 1;
  }

  template <typename T>
  static int component_type() {
    if (std::is_same_v<T, int8_t>) return 5120;
    if (std::is_same_v<T, uint8_t>) return 5121;
    if (std::is_same_v<T, int16_t>) return 5122;
    if (std::is_same_v<T, uint16_t>) return 5123;
    return std::is_same_v<T, uint32_t> ? 5125 : 5126;
  }

  /// @returns the new accessor's index
  template <typename T>
  size_t accessor(const std::vector<T>& values, int components, bool normalized = false) {
    const char* types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const size_t index = view(values);
    json["accessors"].push_back({{"bufferView", index},
                                 {"componentType", component_type<T>()},
                                 {"count", values.size() / components},
                                 {"type", types[components - 1]}});
    if (normalized) json["accessors"].back()["normalized"] = true;
    return json["accessors"].size() - 1;
  }

  /// A mesh of one primitive. @returns its index
  size_t mesh(const nlohmann::json& attributes) {
    json["meshes"].push_back({{"primitives", {{{"attributes", attributes}}}}});
    return json["meshes"].size() - 1;
  }
  nlohmann::json& primitive(size_t mesh = 0) { return json["meshes"][mesh]["primitives"][0]; }

  std::string text() const {
    nlohmann::json whole = json;
    if (!bytes.empty() && !whole.contains("buffers"))
      whole["buffers"] = {
          {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    return whole.dump();
  }

  std::string glb() const {
    nlohmann::json whole = json;
    whole["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string document = whole.dump(), binary = bytes;
    document.resize((document.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    return "glTF" + word(2) + word(static_cast<uint32_t>(28 + document.size() + binary.size())) +
           word(static_cast<uint32_t>(document.size())) + "JSON" + document +
           word(static_cast<uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
  }
};

/// The unit square in z = 0, counter-clockwise from +Z: vertices (0,0) (1,0) (1,1) (0,1), two indexed triangles, one
/// node.
inline GltfBuilder unit_square() {
  GltfBuilder builder;
  const size_t positions = builder.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
  const size_t indices = builder.accessor<uint16_t>({0, 1, 2, 0, 2, 3}, 1);
  builder.mesh({{"POSITION", positions}});
  builder.primitive()["indices"] = indices;
  builder.json["nodes"] = {{{"name", "square"}, {"mesh", 0}}};
  builder.json["scenes"] = {{{"nodes", {0}}}};
  return builder;
}
