#pragma once
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "progress.h"
#include "scene/scene.h"
#include "voxel/grid.h"

namespace voxref {

enum class VoxelOpacity : uint8_t {
  occupied,  ///< 1 wherever there is surface
  coverage   ///< projected area of the surface in the voxel over the voxel's own, along the mean normal, at most 1
};

struct VoxelizeOptions {
  VoxelOpacity opacity = VoxelOpacity::occupied;
};

/// The occupied voxels of a grid: what the surfaces in each are like on average, weighted by area. Structure of arrays, one
/// entry per occupied voxel, sorted by index z, y, x. Empty space takes no memory.
struct SurfaceGrid {
  Grid grid;
  std::vector<glm::ivec3> voxels;    ///< index of each occupied voxel
  std::vector<glm::vec4> albedo;     ///< rgb in [0,1], linear: diffuse albedo plus that of the specular lobe; a = opacity
  std::vector<glm::vec3> normal;     ///< mean of unit normals, out of the front; length in [0,1] tells their spread
  std::vector<glm::vec3> centroid;   ///< world
  std::vector<glm::vec3> emission;   ///< mean emitted radiance, W/(sr m^2); empty: nothing in the scene emits
  size_t size() const { return voxels.size(); }
  size_t bytes() const;
};

/// Clips every triangle against every voxel that it overlaps (26-separating) and weighs each piece by its area: mean albedo,
/// normal, emission and centroid do not depend on triangle order, thread count or tessellation beyond rounding. Area on a
/// face shared by two voxels counts half to each. Holes of alpha masks have no area. Spec section 2 (exact).
SurfaceGrid voxelize(const Scene& scene, const Grid& grid, const VoxelizeOptions& options, const Progress& progress = {});

}  // namespace voxref
