#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <tuple>

#include "scene/scene.h"

namespace voxref {

struct GridOptions {
  static constexpr int least_resolution = 16, most_resolution = 2048;

  int resolution = 256;  ///< voxels along the longest side, in that range; with `cubic` a power of two
  bool cubic = false;    ///< a cube from the box's minimum corner, without margin, as the published shaders do
  std::optional<Bounds> bounds{};  ///< box in place of the scene's own, world units; taken as it is, without margin
};

/// A box of cubic voxels. Voxel (x,y,z) covers min + h [x,x+1) x [y,y+1) x [z,z+1).
struct Grid {
  glm::ivec3 size{0};   ///< voxels per side
  glm::vec3 min{0.0f};  ///< world
  float voxel = 1.0f;   ///< side of a voxel, world units
  /// Centre of the box that the grid covers, where that is not the grid's own: a cube begins at the box's minimum
  /// corner, and the published views look at the box's centre. World.
  std::optional<glm::vec3> box_center{};

  glm::vec3 max() const { return min + voxel * glm::vec3(size); }
  glm::vec3 center(const glm::ivec3& v) const { return min + voxel * (glm::vec3(v) + 0.5f); }
  /// World position in voxel units: the grid is [0,size], voxel centres are at half-integers.
  glm::vec3 to_voxels(const glm::vec3& world) const { return (world - min) / voxel; }
  bool contains(const glm::ivec3& v) const {
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < size.x && v.y < size.y && v.z < size.z;
  }
  size_t voxel_count() const { return size_t(size.x) * size_t(size.y) * size_t(size.z); }
};

/// The order of voxels: by z, then y, then x.
inline bool before(const glm::ivec3& a, const glm::ivec3& b) {
  return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
}

/// Fits a grid around `bounds`: h = longest side / (resolution - 3), at least 4 voxels a side, the box centred, at
/// least 1.5 voxels of margin, so that walls on the bounds of the longest axis lie at voxel centres rather than on
/// voxel faces; so does a scene that is flat along an axis, which gets 5 voxels there. Empty or point-like bounds give
/// a 4^3 grid of unit voxels around them. Spec section 1 (radiometric).
/// With options.cubic: a cube whose side is the longest of `bounds`, from their minimum corner (villegas2016).
/// options.bounds take the place of `bounds`.
/// @throws Error for a resolution out of range, or where float32 coordinates cannot tell such voxels apart
Grid fit_grid(const Bounds& bounds, const GridOptions& options);

/// A grid that was read from a file, with the box_center that fit_grid() would give it.
Grid with_box_center(Grid grid, const Bounds& bounds, const GridOptions& options);

}  // namespace voxref
