#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "progress.h"
#include "scene/scene.h"
#include "voxel/clip.h"
#include "voxel/grid.h"

namespace voxref {

/// A scene's triangles in a grid's own coordinates: in voxels, double precision.
class VoxelTriangles {
 public:
  /// Keeps references to both.
  VoxelTriangles(const Scene& scene, const Grid& grid);

  /// Corners that lie in a voxel face but for float32 rounding are put there: rounding would else hand a wall in the
  /// face to one neighbour, or occupy voxels with slivers of surfaces that end there.
  ClipPolygon operator()(uint32_t triangle) const;
  const Grid& grid() const { return grid_; }
  /// How far float32 rounding can move a corner, in voxels.
  double rounding() const { return rounding_; }

 private:
  const Scene& scene_;
  const Grid& grid_;
  double rounding_;
};

/// The triangles that reach into a brick of 8^3 voxels.
struct TriangleBin {
  glm::ivec3 brick{0};
  size_t begin = 0, end = 0;  ///< in TriangleBins::triangles
};

struct TriangleBins {
  std::vector<TriangleBin> bins;    ///< of the bricks that are not empty, sorted z, y, x
  std::vector<uint32_t> triangles;  ///< ascending in each bin
};

/// Finds by clipping which triangles reach into which bricks; triangles without area reach nowhere.
/// @param chosen one per triangle of the scene: whether it counts
TriangleBins bin_triangles(const VoxelTriangles& triangles, const std::vector<bool>& chosen, const Progress& progress);

}  // namespace voxref
