#pragma once
#include "study/ladder.h"

namespace voxref {

/// Every rung against the one before and against the path tracer, per region, and the ends against each other.
Table ladder_table(const StudyScene& scene, const LadderClimb& climb, const std::vector<Region>& regions);

/// For each region a waterfall of signed bias, and one for all of the RMS difference from the path tracer, up to the
/// goal's parameters; and the same of those and of what follows them. @param goal what the latter lead to
std::vector<Chart> ladder_charts(const StudyScene& scene, const LadderClimb& climb, const std::vector<Region>& regions,
                                 const std::string& goal);

}  // namespace voxref
