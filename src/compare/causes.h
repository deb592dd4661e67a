#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/difference.h"
#include "compare/field.h"
#include "compare/mistakes.h"
#include "progress.h"

namespace voxref {

/// A classic mistake that explains why an array differs from its reference: undone, the difference vanishes.
struct Cause {
  std::string mistake;           ///< what the array under test seems to have done to the reference
  double before = 0, after = 0;  ///< mean of |a - b| / (|a| + |b|) over the places compared, in [0,1]
};

/// Tries every classic mistake alone, then every one of place together with every one of value.
/// @param a under test @param b reference; both finite. Sizes may differ where swapped axes explain it
/// @param vanishes the judge: whether nothing that counts is different any more once this mistake is undone
/// @return those that explain it best, the simplest first; empty: none of them does
std::vector<Cause> likely_causes(const Field& a, const Field& b,
                                 const std::function<bool(const Mistake& mistake)>& vanishes,
                                 const Progress& progress = {});

/// A judge for arrays without noise: 99.9 % of the places agree, each channel within the tolerance.
bool explains(const Mistake& mistake, const Field& a, const Field& b, const Tolerance& tolerance);

nlohmann::json to_json(const std::vector<Cause>& causes);

}  // namespace voxref
