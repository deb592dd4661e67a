#include "voxel/texel_format.h"

#include <algorithm>
#include <array>

namespace voxref {

namespace {

constexpr std::array<TexelFormat, 9> formats = {{{"r8g8b8a8_unorm", 28, ElementType::uint8, 4},
                                                 {"r8g8b8a8_unorm_srgb", 29, ElementType::uint8, 4, true},
                                                 {"r8_unorm", 61, ElementType::uint8, 1},
                                                 {"r32_uint", 42, ElementType::uint8, 4},
                                                 {"r16g16b16a16_float", 10, ElementType::float16, 4},
                                                 {"r16_float", 54, ElementType::float16, 1},
                                                 {"r32g32b32a32_float", 2, ElementType::float32, 4},
                                                 {"r32g32b32_float", 6, ElementType::float32, 3},
                                                 {"r32_float", 41, ElementType::float32, 1}}};

const TexelFormat* found(const TexelFormat* format) { return format == formats.end() ? nullptr : format; }

}  // namespace

const TexelFormat* texel_format(std::string_view name) {
  return found(std::ranges::find(formats, name, &TexelFormat::name));
}

const TexelFormat* texel_format(uint32_t dxgi) { return found(std::ranges::find(formats, dxgi, &TexelFormat::dxgi)); }

std::string texel_format_names() {
  std::string names;
  for (const TexelFormat& format : formats) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

}  // namespace voxref
