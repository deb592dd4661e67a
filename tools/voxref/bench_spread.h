#pragma once
#include <nlohmann/json.hpp>

#include "compare/statistics.h"

namespace voxref {

inline nlohmann::json to_json(const Spread& s) { return {{"median", s.median}, {"min", s.least}, {"max", s.greatest}}; }

}  // namespace voxref
