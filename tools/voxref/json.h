#pragma once
#include <nlohmann/json.hpp>

#include "pipeline.h"
#include "reference/path.h"

namespace voxref {

// The keys that scripts read. Floats are written with their shortest decimals.

nlohmann::json to_json(const glm::vec3& v);  ///< [x, y, z]
nlohmann::json to_json(const PathResult& result);
nlohmann::json to_json(const ConeTraceResult& result);
nlohmann::json to_json(const StageSeconds& seconds);

}  // namespace voxref
