#pragma once
#include <cstdint>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "progress.h"
#include "scene/scene.h"
#include "voxel/grid.h"

namespace voxref {

/// What a pixel of a triangle averages into a voxel; 1 is 255.
struct FragmentValue {
  glm::vec3 albedo{0.0f}, normal{0.0f}, emission{0.0f};  ///< normal as 0.5 n + 0.5
};

/// The pixels of some triangles, in draw order. Those of a flat triangle without textures have one value between them,
/// so that most pixels take twelve bytes.
struct VoxelFragments {
  struct Fragment {
    glm::u16vec3 voxel;  ///< in the grid
    uint32_t value;      ///< index
  };
  std::vector<Fragment> fragments;
  std::vector<FragmentValue> values;
};

/// The fragments of all static or all dynamic triangles, in draw order, cut into chunks; the cut does not depend on the
/// number of threads. Spec section 2 (raster), steps 1 to 5. The published program's vertices have no colours; those of
/// glTF's multiply Kd and the opacity here, as they do in voxels that are clipped and in pixels.
/// @param grid at most 65536 voxels a side
std::vector<VoxelFragments> draw_fragments(const Scene& scene, const Grid& grid, bool dynamic,
                                           const Progress& progress);

}  // namespace voxref
