#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"

namespace voxref {

/// True for the name of a channel that shall be read. Empty: all are.
using ChannelFilter = std::function<bool(const std::string& channel)>;

/// Files have pixels interleaved, [y][x][channel]; voxref keeps planes.
std::vector<float> interleave(const Image& image);

/// Adds the channels of an interleaved picture to an image of its size.
/// @param names of its channels; those that are not wanted are left out
void add_interleaved(Image& image, std::span<const float> pixels, std::span<const std::string> names,
                     const ChannelFilter& wanted);

/// An image of this size for the content of a file. @throws Error with the file where there is no such size
Image image_for_file(const std::string& file, size_t width, size_t height);

}  // namespace voxref
