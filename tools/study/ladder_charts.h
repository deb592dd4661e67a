#pragma once
#include "study/ladder.h"

namespace voxref {

/// Mean over pixels and tries, radiance.
double mean(const RungImage& image);

/// Every rung against the one before, per region, and the ends against each other.
Table ladder_table(const StudyScene& scene, const LadderClimb& climb, const std::vector<Region>& regions);

/// Waterfalls of signed bias, one per region, up to the published rungs and through those; and the RMS of each rung's
/// own change, likewise.
std::vector<Chart> ladder_charts(const StudyScene& scene, const LadderClimb& climb, const std::vector<Region>& regions);

}  // namespace voxref
