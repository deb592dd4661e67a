#pragma once
#include <nlohmann/json.hpp>

#include "compare/comparison_page.h"

namespace voxref {

/// What the script of the page draws: size, exposure, names, colour maps, and for each layer both images as floats of 8
/// significant bits (7 where values are negative), in a PNG as base64. Layers that an image lacks, and all but the
/// first where the page would grow too large, are left out.
nlohmann::json page_data(const ComparisonPage& page);

}  // namespace voxref
