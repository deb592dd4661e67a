#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "progress.h"
#include "scene/scene.h"
#include "voxel/grid.h"

namespace voxref {

/// What one pixel of a triangle averages into a voxel; 1 is 255.
struct VoxelFragment {
  glm::ivec3 voxel{0};                                   ///< in the grid
  glm::vec3 albedo{0.0f}, normal{0.0f}, emission{0.0f};  ///< normal as 0.5 n + 0.5
};

/// The fragments of all static or all dynamic triangles, in draw order, cut into chunks; the cut does not depend on the
/// number of threads. Spec section 2 (raster), steps 1 to 5.
std::vector<std::vector<VoxelFragment>> draw_fragments(const Scene& scene, const Grid& grid, bool dynamic,
                                                       const Progress& progress);

}  // namespace voxref
