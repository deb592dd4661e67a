#pragma once
#include <string>
#include <string_view>

#include "image/image.h"

namespace voxref {

/// The part of an image that is compared, as layer "" with the standard errors that belong to it.
/// @param expression one layer or the sum of several: "" (R,G,B), "direct", "diffuse+specular", "N" (N.X,Y,Z); or one
///        channel, which stands for all three colours: "Z", "ao.Y". An image without R,G,B gives its Y, or its only
///        channel, for "". The errors of "" are stderr.R,G,B,Y, those of another layer stderr.LAYER.Y; a sum has none.
/// @throws Error naming the term that the image lacks, and what it has
Image select_layer(const Image& image, const std::string& expression);

/// Whether a channel of a file may be needed for the expression: what is certainly not need not be read.
bool layer_needs(const std::string& expression, std::string_view channel);

}  // namespace voxref
