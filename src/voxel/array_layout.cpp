#include "voxel/array_layout.h"

#include <cassert>
#include <limits>

namespace voxref {

std::optional<uint64_t> packed_bytes(ElementType type, const std::array<size_t, 4>& shape) {
  uint64_t bytes = bytes_of(type);
  for (const size_t side : shape) {
    if (side != 0 && bytes > uint64_t(std::numeric_limits<int64_t>::max()) / side) return std::nullopt;
    bytes *= side;
  }
  return bytes;
}

ArrayLayout packed_layout(ElementType type, const std::array<size_t, 4>& shape, uint64_t origin) {
  assert(packed_bytes(type, shape));
  ArrayLayout layout{type, shape, origin};
  layout.stride[2] = int64_t(shape[3] * bytes_of(type));
  layout.stride[1] = layout.stride[2] * int64_t(shape[2]);
  layout.stride[0] = layout.stride[1] * int64_t(shape[1]);
  return layout;
}

}  // namespace voxref
