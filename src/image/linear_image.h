#pragma once
#include <filesystem>
#include <optional>

#include "image/image.h"
#include "image/image_file.h"
#include "image/transfer.h"

namespace voxref {

/// Reads a picture of linear light from any file: those of read_image, and images in .npy, .dds and .raw
/// (array_file.h), whose channels are called by their number: Y; R,G; R,G,B; R,G,B,A.
///
/// What undoes a transfer, in this order: the one given; what the file says (PNG's gamma and sRGB chunks, TIFF's and
/// others' tags, the _srgb formats of DDS and raw); sRGB where an image file holds integers; none. Alpha, and a layer's
/// channels that are called otherwise than R, G, B and Y, are never decoded.
/// @param wanted called with each channel's name; others are left out, and where the format allows it not even read
/// @param mip level of detail of a file that array_file.h reads; others have none
/// @throws Error `FILE: PLACE: what is wrong`; for a volume; for a file that says another transfer than voxref knows
Image read_linear_image(const std::filesystem::path& file, std::optional<Transfer> transfer = std::nullopt,
                        const ChannelFilter& wanted = {}, int mip = 0);

}  // namespace voxref
