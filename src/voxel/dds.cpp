#include "voxel/dds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "error.h"
#include "printable.h"
#include "voxel/texel_format.h"

namespace voxref {

namespace {

constexpr uint32_t largest_side =
    65536;  // beyond it a size is damage; four times any texture's, so that sums fit 64 bits

constexpr uint32_t four_characters(const char (&code)[5]) {
  return uint32_t(code[0]) | uint32_t(code[1]) << 8 | uint32_t(code[2]) << 16 | uint32_t(code[3]) << 24;
}

/// DDS_PIXELFORMAT.
struct PixelFormat {
  uint32_t size, flags, four_cc, bit_count, red_mask, green_mask, blue_mask, alpha_mask;
};
constexpr uint32_t has_four_cc = 0x4;  // DDPF_FOURCC

/// The file's first word and DDS_HEADER.
struct Header {
  uint32_t magic, size, flags, height, width, pitch, depth, mip_count, reserved[11];
  PixelFormat format;
  uint32_t caps[4], reserved2;
};
static_assert(sizeof(Header) == 4 + 124 && sizeof(PixelFormat) == 32);
constexpr uint32_t any_cube_face = 0xfe00, is_volume = 0x200000;  // caps[1]: DDSCAPS2_CUBEMAP and its faces, _VOLUME

/// DDS_HEADER_DXT10.
struct Extension {
  uint32_t dxgi_format, dimension, flags, array_size, flags2;
};
constexpr uint32_t texture_2d = 3, texture_3d = 4;  // DDS_DIMENSION_*
constexpr uint32_t is_cube = 0x4;                   // DDS_RESOURCE_MISC_TEXTURECUBE

/// What the headers say of a texture.
struct Texture {
  TexelFormat format;
  uint32_t width, height, depth, mip_count;
  uint64_t begin;  ///< of the texels in the file
};

template <class Part>
Part read_part(BinaryFile& file, uint64_t offset) {
  std::array<std::byte, sizeof(Part)> bytes;
  if (file.size() < offset + sizeof(Part)) throw Error(file.name(), "header", "ends too early");
  file.read(offset, bytes);
  return std::bit_cast<Part>(bytes);
}

[[noreturn]] void refuse(const BinaryFile& file, const std::string& what) { throw Error(file.name(), "header", what); }

TexelFormat masked_format(const BinaryFile& file, const PixelFormat& format) {
  const std::array masks{format.red_mask, format.green_mask, format.blue_mask, format.alpha_mask};
  if (format.bit_count == 32 && masks == std::array{0xffu, 0xff00u, 0xff0000u, 0xff000000u})
    return *texel_format("r8g8b8a8_unorm");
  if (format.bit_count == 8 && masks == std::array{0xffu, 0u, 0u, 0u}) return *texel_format("r8_unorm");
  refuse(file,
         "bit masks of " + std::to_string(format.bit_count) + " bits are not those of r8g8b8a8_unorm or r8_unorm");
}

/// Reads the extension and holds it against the header. @param volume by the header alone
TexelFormat extended_format(BinaryFile& file, const Header& header, bool volume) {
  const auto extension = read_part<Extension>(file, sizeof(Header));
  const TexelFormat* format = texel_format(extension.dxgi_format);
  if (!format)
    refuse(file, "DXGI format " + std::to_string(extension.dxgi_format) + " is none of " + texel_format_names());
  if (extension.dimension != texture_2d && extension.dimension != texture_3d)
    refuse(file, "dimension " + std::to_string(extension.dimension) + " is neither 3 (2D texture) nor 4 (volume)");
  if (extension.dimension == texture_2d && volume) refuse(file, "is of a 2D texture and of a volume");
  if (extension.dimension == texture_3d && header.depth == 0) refuse(file, "is of a volume without depth");
  if ((extension.flags & is_cube) != 0) refuse(file, "is of a cube map");
  if (extension.array_size != 1)
    refuse(file, "is of an array of " + std::to_string(extension.array_size) + " textures; save one of them");
  return *format;
}

Texture read_texture(BinaryFile& file) {
  const auto header = read_part<Header>(file, 0);
  if (header.magic != four_characters("DDS ") || header.size != sizeof(Header) - 4 ||
      header.format.size != sizeof(PixelFormat))
    refuse(file, "is not that of a DDS file");
  if ((header.caps[1] & any_cube_face) != 0) refuse(file, "is of a cube map");
  const bool volume = (header.caps[1] & is_volume) != 0, four_cc = (header.format.flags & has_four_cc) != 0;
  const bool extended = four_cc && header.format.four_cc == four_characters("DX10");
  if (four_cc && !extended) {
    const auto name = std::bit_cast<std::array<char, 4>>(header.format.four_cc);
    refuse(file, "format '" + printable({name.data(), name.size()}) + "' is none of " + texel_format_names());
  }
  const TexelFormat format = extended ? extended_format(file, header, volume) : masked_format(file, header.format);
  // Writers leave out flags, and some a count of 1: only the numbers themselves are to be relied on.
  Texture texture{format,
                  header.width,
                  header.height,
                  std::max(header.depth, 1u),
                  std::max(header.mip_count, 1u),
                  sizeof(Header) + (extended ? sizeof(Extension) : 0)};
  for (const uint32_t side : {texture.width, texture.height, texture.depth})
    if (side < 1 || side > largest_side) refuse(file, "has a side of " + std::to_string(side));
  if (texture.depth > 1 && !volume && !extended) refuse(file, "has depth, and is of no volume");
  if (texture.mip_count > std::bit_width(std::max({texture.width, texture.height, texture.depth})))
    refuse(file, "has " + std::to_string(texture.mip_count) + " mip levels, more than the texture's size allows");
  return texture;
}

}  // namespace

ArrayLayout dds_layout(BinaryFile& file, int mip) {
  const Texture texture = read_texture(file);
  const auto side = [](uint32_t full, uint32_t level) { return size_t(std::max(full >> level, 1u)); };
  ArrayLayout layout;
  uint64_t end = texture.begin;
  for (uint32_t level = 0; level < texture.mip_count; ++level) {
    const std::array<size_t, 4> shape = {side(texture.depth, level), side(texture.height, level),
                                         side(texture.width, level), texture.format.channels};
    if (int(level) == mip) layout = packed_layout(texture.format.type, shape, end);
    end += *packed_bytes(texture.format.type, shape);
  }
  if (file.size() != end)
    throw Error(file.name(), "holds " + std::to_string(file.size()) + " bytes instead of " + std::to_string(end) +
                                 (file.size() < end ? ": truncated" : ""));
  if (mip < 0 || uint32_t(mip) >= texture.mip_count)
    throw Error(file.name(), "mip " + std::to_string(mip),
                "is not there: the file has " + std::to_string(texture.mip_count));
  layout.srgb = texture.format.srgb;
  layout.mip_count = int(texture.mip_count);
  return layout;
}

}  // namespace voxref
