#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/gltf_value.h"
#include "scene/texture.h"

namespace voxref {

/// A range of bytes of a buffer, checked to lie inside it.
struct GltfBufferView {
  uint32_t buffer = 0;
  size_t offset = 0, length = 0;  ///< bytes
  size_t stride = 0;              ///< bytes between elements; 0: tightly packed
};

/// A glTF 2.0 file: what it says (`json`) and the bytes that it refers to.
///
/// tinygltf carries the bytes: it takes GLB files apart, decodes data URIs and images and opens external files. What
/// the document says is read with GltfValue instead of from tinygltf's model, because tinygltf turns what it does not
/// understand into defaults: "indices": "0" becomes no indices, a byteOffset of -4 becomes 0, an index out of range
/// stays.
struct GltfDocument {
  std::string file;  ///< as the user named it
  nlohmann::json json;
  std::vector<GltfBufferView> views;
  std::vector<std::vector<unsigned char>> buffers;  ///< each at least as long as its byteLength
  std::vector<TextureImage> images;                 ///< decoded
  std::string content;                              ///< the file's own bytes, followed by those of its external files
  std::vector<std::string> warnings;

  GltfValue root() const { return {json, file}; }
  std::vector<GltfValue> list(const std::string& key) const { return root().items(key); }
  size_t count(const std::string& key) const { return root().items(key).size(); }
  bool uses(const std::string& extension) const;
};

/// Reads the file and parses its JSON; checks version, extensions, buffers and buffer views, which load_bytes relies
/// on.
/// @throws Error FILE: PLACE: what
GltfDocument open_gltf(const std::filesystem::path& file);

/// Fills `buffers` and `images`, and appends external files to `content` in their order of use.
/// @throws Error FILE: PLACE: what
void load_bytes(GltfDocument& document);

}  // namespace voxref
