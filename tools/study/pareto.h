#pragma once
#include <limits>
#include <span>
#include <vector>

#include "study/setting_space.h"
#include "study/study.h"

namespace voxref {

/// What a picture costs and how wrong it is.
struct Tradeoff {
  double seconds = 0, error = 0;
};

/// Indices of those that no other beats in one without losing in the other, by rising time; none whose error is NaN.
std::vector<size_t> pareto_frontier(std::span<const Tradeoff> points);

/// What is tried, and how carefully.
struct ParetoGrid {
  SettingSpace space;
  int width = 64;  ///< pixels
  int reference_spp = 256;
  int most_spp = 64;  ///< of the path tracer on the chart
  int seeds = 4;      ///< independent path-traced images per number of samples, at least 2
  int rounds = 3;     ///< in which a setting's time is measured
  double long_enough = std::numeric_limits<double>::infinity();  ///< seconds; of settings that take more one round does
};

/// One chart and two tables for one scene. Times are medians over the rounds, with the least and the greatest; errors
/// have 95 % confidence limits. @throws Interrupted
Section pareto_section(const StudyScene& scene, const ParetoGrid& grid, const Progress& progress);

}  // namespace voxref
