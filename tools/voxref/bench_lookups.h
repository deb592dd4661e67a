#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "settings.h"
#include "terminal.h"

namespace voxref {

/// What one look-up takes, on one thread.
struct LookupBench {
  std::string kind;
  double volume = 0;  ///< nanoseconds at the scene's occupied voxels in an order of their own, levels 0 to 4
  double bare = 0;    ///< the same loop over a volume that fits the first cache
};

/// Look-ups as cones make them, trilinear in one level and quadrilinear between two: in the radiometric medium of
/// float32 texels, one by one, and in the published profile's volumes of bytes, whose places are worked out eight at a
/// time. @throws Error for a scene that occupies no voxel
std::vector<LookupBench> bench_lookups(const Scene& scene, const Settings& settings);

void say(Terminal& terminal, const std::vector<LookupBench>& lookups);
nlohmann::json to_json(const std::vector<LookupBench>& lookups);

}  // namespace voxref
