#include "voxel/grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <string>

#include "error.h"

namespace voxref {

namespace {

constexpr int margins = 3;   // two of 1.5 voxels
constexpr int min_side = 4;  // below it a coarse level would be all margin
// A surface without depth along an axis gets an odd count, so that it lies at voxel centres too.
constexpr int flat_side = 5;
// Extents that are whole voxels but for rounding shall not grow by a voxel.
constexpr double rounding = 1e-4;

/// Largest coordinate, in absolute value.
double reach(const Bounds& bounds) {
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(double(bounds.min[axis])), std::abs(double(bounds.max[axis]))});
  return largest;
}

/// Voxels that an extent needs, without margins.
int voxels_across(double extent, double voxel) { return int(std::ceil(extent / voxel - rounding)); }

int voxels_along(double extent, double voxel) {
  if (extent <= rounding * voxel) return flat_side;
  return std::max(min_side, voxels_across(extent, voxel) + margins);
}

void require_resolution(const GridOptions& options) {
  const std::string given = std::to_string(options.resolution);
  constexpr int least = GridOptions::least_resolution, most = GridOptions::most_resolution;
  if (options.resolution < least || options.resolution > most)
    throw Error("grid.resolution", given + " is outside " + std::to_string(least) + " to " + std::to_string(most));
  if (options.cubic && (options.resolution & (options.resolution - 1)) != 0)
    throw Error("grid.resolution", given + " is not a power of two, which grid.cubic asks for");
}

void require_distinct_voxels(const Grid& grid, const Bounds& bounds) {
  const double spacing = reach(bounds) * std::numeric_limits<float>::epsilon();  // of float32 numbers out there
  if (!std::isfinite(grid.voxel) || grid.voxel < std::numeric_limits<float>::min() || grid.voxel < 4.0 * spacing)
    throw Error("grid", "voxels of " + std::to_string(grid.voxel) + " world units cannot be told apart in float32 at " +
                            "coordinates up to " + std::to_string(reach(bounds)) + "; lower grid.resolution");
}

/// A grid that begins at the box's minimum corner and has no margin. float32 as the published program computes it.
Grid anchored_grid(const Bounds& box, const GridOptions& options) {
  const glm::vec3 extent = box.extent();
  const float longest = std::max({extent.x, extent.y, extent.z});
  Grid grid;
  grid.size = glm::ivec3(options.resolution);
  grid.min = box.min;
  grid.voxel = longest / float(options.resolution);
  if (options.cubic) grid.box_center = box.center();
  require_distinct_voxels(grid, box);
  if (!options.cubic)
    for (int axis = 0; axis < 3; ++axis) grid.size[axis] = std::max(1, voxels_across(extent[axis], grid.voxel));
  return grid;
}

/// Unit voxels around a point.
Grid unit_voxels(const glm::dvec3& center, int side) {
  Grid grid;
  grid.size = glm::ivec3(side);
  grid.min = glm::vec3(center - 0.5 * side);
  return grid;
}

}  // namespace

Grid fit_grid(const Bounds& scene_bounds, const GridOptions& options) {
  require_resolution(options);
  const Bounds& bounds = options.bounds ? *options.bounds : scene_bounds;
  const glm::dvec3 low = bounds.empty() ? glm::dvec3(0.0) : glm::dvec3(bounds.min);
  const glm::dvec3 high = bounds.empty() ? glm::dvec3(0.0) : glm::dvec3(bounds.max);
  const glm::dvec3 center = 0.5 * (low + high), extent = high - low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0.0)) return unit_voxels(center, options.cubic ? options.resolution : min_side);
  if (options.cubic || options.bounds) return anchored_grid(bounds, options);

  Grid grid;
  grid.voxel = float(longest / (options.resolution - margins));
  require_distinct_voxels(grid, bounds);
  for (int axis = 0; axis < 3; ++axis)
    // The longest axis is known without rounding.
    grid.size[axis] = extent[axis] == longest ? options.resolution : voxels_along(extent[axis], grid.voxel);
  const glm::dvec3 half = 0.5 * double(grid.voxel) * glm::dvec3(grid.size);
  grid.min = glm::vec3(center - half);
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(center[axis]) + half[axis] > std::numeric_limits<float>::max())
      throw Error("grid", "the scene and its margin reach beyond what float32 can express");
  return grid;
}

Grid with_box_center(Grid grid, const Bounds& bounds, const GridOptions& options) {
  if (options.cubic) grid.box_center = (options.bounds ? *options.bounds : bounds).center();
  return grid;
}

}  // namespace voxref
