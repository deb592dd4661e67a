#pragma once
#include <span>
#include <vector>

#include "settings.h"
#include "study/study.h"

namespace voxref {

/// What a picture costs and how wrong it is.
struct Tradeoff {
  double seconds = 0, error = 0;
};

/// Indices of those that no other beats in one without losing in the other, by rising time.
std::vector<size_t> pareto_frontier(std::span<const Tradeoff> points);

/// The values of the parameters whose product is tried.
struct ParetoGrid {
  std::vector<int> resolutions, cones;
  std::vector<float> steps;
  std::vector<std::optional<int>> bounces;  ///< none: auto
  std::vector<Storage> storages;
  int width = 64;  ///< pixels
  int reference_spp = 256;
  int most_spp = 64;  ///< of the path tracer on the chart
  int seeds = 4;      ///< independent path-traced images per number of samples
};

/// One chart and two tables for one scene.
Section pareto_section(const StudyScene& scene, const ParetoGrid& grid, const Progress& progress);

}  // namespace voxref
