#pragma once
#include <cstdint>
#include <vector>

#include "scene/gltf_document.h"

namespace voxref {

enum class Component : uint16_t { int8 = 5120, uint8, int16, uint16, uint32 = 5125, float32 };

/// A typed array of elements in a buffer, its byte ranges checked to lie inside its buffer views.
struct GltfAccessor {
  struct Range {
    int view = -1;      ///< index into GltfDocument::views; -1: all zeros
    size_t offset = 0;  ///< bytes from the view's start
  };
  struct Sparse {
    size_t count = 0;  ///< elements that replace those of the array
    Component index_component = Component::uint32;
    Range indices, values;
  };

  std::string place;
  Component component = Component::float32;
  bool normalized = false;
  int components = 1;  ///< numbers per element: 1 to 4, matrices 4, 9, 16
  bool matrix = false;
  size_t count = 0;   ///< elements
  size_t stride = 0;  ///< bytes from one element to the next
  Range range;
  Sparse sparse;
};

/// Every accessor of the document, whether anything uses it or not. @throws Error FILE: PLACE: what
std::vector<GltfAccessor> read_accessors(const GltfDocument& document);

/// The accessor's numbers, `components` per element, all finite. Normalized integers become [0,1] or [-1,1] (glTF 2.0,
/// 3.11), others keep their value. The document's bytes must be loaded. @throws Error FILE: PLACE: what
std::vector<float> read_floats(const GltfDocument& document, const GltfAccessor& accessor);

/// The numbers of an unsigned integer accessor. @throws Error FILE: PLACE: what
std::vector<uint32_t> read_unsigned(const GltfDocument& document, const GltfAccessor& accessor);

}  // namespace voxref
