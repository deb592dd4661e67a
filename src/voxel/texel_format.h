#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "voxel/array_layout.h"

namespace voxref {

/// How a GPU holds a texel, under the name that DXGI has for it, in small letters.
struct TexelFormat {
  std::string_view name;  ///< "r8g8b8a8_unorm"
  uint32_t dxgi;          ///< DXGI_FORMAT's number
  ElementType type;
  size_t channels;
  bool srgb = false;  ///< a sampler would decode red, green and blue by sRGB's transfer function
};

/// Null where the format is not one that voxref reads. r32_uint is read as four packed bytes, red lowest: what shaders
/// that average by atomic operations on an image write.
const TexelFormat* texel_format(std::string_view name);
const TexelFormat* texel_format(uint32_t dxgi);
/// The names of all formats, for messages.
std::string texel_format_names();

}  // namespace voxref
