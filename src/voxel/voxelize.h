#pragma once
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "progress.h"
#include "scene/scene.h"
#include "voxel/grid.h"

namespace voxref {

enum class VoxelizeMethod : uint8_t {
  exact,  ///< clips triangles against voxels
  raster  ///< one fragment per pixel of the triangle's main axis, as the published shaders do
};
enum class VoxelAverage : uint8_t {
  area,           ///< of the pieces of surface, in any order
  running_floor8  ///< in bytes that are rounded down after each fragment, in draw order
};
enum class VoxelOpacity : uint8_t {
  occupied,  ///< 1 wherever there is surface
  coverage   ///< projected area of the surface in the voxel over the voxel's own, along the mean normal, at most 1
};

struct VoxelizeOptions {
  VoxelizeMethod method = VoxelizeMethod::exact;
  VoxelAverage average = VoxelAverage::area;  ///< running_floor8 goes with raster only
  VoxelOpacity opacity = VoxelOpacity::occupied;
  bool static_wins = false;  ///< dynamic surfaces leave voxels of static ones alone; else they share them
};

/// The occupied voxels of a grid: what the surfaces in each are like on average, weighted by area. Structure of arrays,
/// one entry per occupied voxel, sorted by index z, y, x. Empty space takes no memory.
struct SurfaceGrid {
  Grid grid;
  std::vector<glm::ivec3> voxels;  ///< index of each occupied voxel
  std::vector<float> area;         ///< of the surface in the voxel, square world units; empty: not known
  std::vector<uint8_t> fragments;  ///< averaged into each voxel, modulo 256; empty unless running_floor8
  std::vector<uint8_t> dynamic;    ///< 1: no static surface is in the voxel; empty: there are none such
  std::vector<glm::vec4> albedo;   ///< rgb in [0,1], linear: diffuse albedo plus that of the specular lobe; a = opacity
  std::vector<glm::vec3> normal;   ///< mean of unit normals, out of the front; length in [0,1] tells their spread
  std::vector<glm::vec3> centroid;  ///< world
  std::vector<glm::vec3> emission;  ///< mean emitted radiance, W/(sr m^2); empty: nothing in the scene emits
  size_t size() const { return voxels.size(); }
  /// Of what every grid has, and of emission where there is some. @param emits anything in the scene
  void resize(size_t count, bool emits);
  size_t bytes() const;
};

/// Mean normals shorter than this come from surfaces that face away from each other: their direction says nothing.
inline constexpr float two_sided_length = 0.25f;

/// Clips every triangle against every voxel that it overlaps (26-separating) and weighs each piece by its area: mean
/// albedo, normal, emission and centroid do not depend on triangle order, thread count or tessellation beyond rounding.
/// Normals are the interpolated vertex normals, without normal maps. Area on a face shared by two voxels counts half to
/// each. Holes of alpha masks have no area; triangles without area contribute nothing. Spec section 2 (exact).
/// @param grid any; surfaces outside it are left out
SurfaceGrid voxelize(const Scene& scene, const Grid& grid, const VoxelizeOptions& options,
                     const Progress& progress = {});

/// The two halves of it, for scenes whose dynamic objects move: the static ones are voxelized once, and for each frame
/// the dynamic ones are added to what they gave. Clears what was dynamic before, since `fixed` holds none of it.
SurfaceGrid voxelize_static(const Scene& scene, const Grid& grid, const VoxelizeOptions& options,
                            const Progress& progress = {});
SurfaceGrid add_dynamic(const Scene& scene, SurfaceGrid fixed, const VoxelizeOptions& options,
                        const Progress& progress = {});

/// Brick coordinates (see BrickVolume) of the bricks that hold occupied voxels, sorted z, y, x.
std::vector<glm::ivec3> occupied_bricks(const SurfaceGrid& surfaces);

}  // namespace voxref
