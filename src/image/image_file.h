#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "image/image.h"

namespace voxref {

/// Writes every channel as 32-bit float OpenEXR, the attributes as string attributes of the header. The file appears
/// whole or not at all. @throws Error with the path when it cannot be written
void write_exr(const std::filesystem::path& file, const Image& image);

/// Reads any image that OpenImageIO reads, as stored: no transfer function is undone. Channels keep their names; string
/// attributes come along. @throws Error with the path when it is missing or damaged
Image read_image(const std::filesystem::path& file);

/// 8-bit RGB, rows from the top, as they shall be shown (already encoded for display): an entire PNG file in memory.
/// @param rgb 3 * width * height bytes
std::vector<uint8_t> encode_png(int width, int height, std::span<const uint8_t> rgb);

/// Encodes linear radiance for a display: x 2^exposure, clipped to [0,1], sRGB transfer (IEC 61966-2-1), 8 bits.
std::vector<uint8_t> display_bytes(const Image& image, std::string_view layer, float exposure);

}  // namespace voxref
