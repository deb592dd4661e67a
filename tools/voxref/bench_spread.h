#pragma once
#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace voxref {

/// Several measurements of one thing.
struct Spread {
  double median = 0, least = 0, greatest = 0;
};

/// @param values at least one
inline Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {median, values.front(), values.back()};
}

inline nlohmann::json to_json(const Spread& s) { return {{"median", s.median}, {"min", s.least}, {"max", s.greatest}}; }

}  // namespace voxref
