#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "voxel/element.h"

namespace voxref {

/// Where the values of a volume or an image lie in their file, whatever its format. An image has one slice.
struct ArrayLayout {
  ElementType type = ElementType::float32;
  std::array<size_t, 4> shape{1, 1, 1, 1};  ///< Z, Y, X, C, each at least 1
  uint64_t origin = 0;                      ///< byte in the file where the value of index 0 begins
  /// Bytes from an index of Z, Y, X to the next, below 0 where the file has the axis the other way round. The channels
  /// of a texel lie side by side.
  std::array<int64_t, 3> stride{};
  bool srgb = false;  ///< the format says that red, green and blue are encoded by sRGB's transfer function
  int mip_count = 1;  ///< in the file
};

/// The layout of an array without gaps whose last index is fastest.
ArrayLayout packed_layout(ElementType type, const std::array<size_t, 4>& shape, uint64_t origin);
/// Bytes that an array of this type and shape takes without gaps; none when that cannot be counted in 63 bits.
std::optional<uint64_t> packed_bytes(ElementType type, const std::array<size_t, 4>& shape);

}  // namespace voxref
