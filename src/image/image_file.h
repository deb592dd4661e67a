#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/interleaved.h"

namespace voxref {

/// Writes every channel as 32-bit float OpenEXR, the attributes as string attributes of the header. The file appears
/// whole or not at all. @throws Error with the path when it cannot be written
void write_exr(const std::filesystem::path& file, const Image& image);

/// An image file's content, with what tells how its numbers are meant.
struct StoredImage {
  Image image;
  bool integers = false;    ///< the file holds integers; the image has them divided by the largest
  std::string color_space;  ///< OpenImageIO's name for what the file says; empty: nothing
};

/// Reads any image that OpenImageIO reads, as stored: no transfer function is undone, nothing multiplied by alpha.
/// Channels keep their names; those of an OpenEXR file's further parts get the part's name as layer, unless they have
/// one that is still free. An OpenEXR file's pixels lie in its display window, 0 where it holds none. String attributes
/// come along.
/// @throws Error with the path when it is missing or damaged, deep, has pixels outside its display window, or its parts
/// differ in that window
StoredImage read_stored_image(const std::filesystem::path& file, const ChannelFilter& wanted = {});
Image read_image(const std::filesystem::path& file);

/// Pixels of layer "" that an observer could tell apart, Yee 2004, "A Perceptual Metric for Production Testing", as
/// OpenImageIO computes it, of linear light, for a display of 100 cd/m^2 that fills 45 degrees. Both images, of equal
/// size and finite, are shown x 2^exposure and clipped to [0,1].
uint64_t yee_difference(const Image& a, const Image& b, float exposure);

/// 8-bit RGB, rows from the top, as they shall be shown (already encoded for display): an entire PNG file in memory.
/// @param rgb 3 * width * height bytes
std::vector<uint8_t> encode_png(int width, int height, std::span<const uint8_t> rgb);

/// Encodes linear radiance for a display: x 2^exposure, clipped to [0,1], sRGB transfer (IEC 61966-2-1), 8 bits.
std::vector<uint8_t> display_bytes(const Image& image, std::string_view layer, float exposure);

}  // namespace voxref
