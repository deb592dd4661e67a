#pragma once
#include <nlohmann/json.hpp>

#include "compare/report.h"

namespace voxref {

/// What the script of the report page draws: size, exposure, colour maps, and for each of the layers total, indirect
/// (cone: diffuse + specular) and direct both images as floats of 8 significant bits, in a PNG as base64. Layers that
/// an image lacks, and all but the first where the page would grow too large, are left out.
nlohmann::json page_data(const CheckReport& report);

}  // namespace voxref
