#pragma once
#include <nlohmann/json.hpp>

#include "compare/comparison_page.h"

namespace voxref {

/// What the script of the page draws: size, exposure, names, colour maps, and `layers`. Of each layer `a` and `b` are
/// the images and `difference` is a - b, as floats of `bits` (8; 7 where values are negative) and `difference_bits` (7
/// to 3, as there is room) significant bits for a pixel's largest channel, in a PNG as base64. Layers that an image
/// lacks, and all but the first where the page would grow too large, are left out. There is one layer at least in both
/// images.
nlohmann::json page_data(const ComparisonPage& page);

}  // namespace voxref
