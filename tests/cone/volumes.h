#pragma once
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "cone/medium.h"
#include "voxel/mipmap.h"
#include "voxel/voxelize.h"

namespace voxref {

/// A grid of `size` unit voxels with its minimum corner at the origin: world units are voxels.
inline Grid unit_grid(const glm::ivec3& size) {
  Grid grid;
  grid.size = size;
  return grid;
}

/// A base volume in which voxel v holds texel(v) (premultiplied); bricks without content are left out.
inline BrickVolume<glm::vec4> fill(const glm::ivec3& size, const std::function<glm::vec4(const glm::ivec3&)>& texel) {
  BrickVolume<glm::vec4> volume(size);
  const auto each = [&](const auto& visit) {
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) visit(glm::ivec3(x, y, z));
  };
  std::vector<glm::ivec3> bricks;
  BrickVolume<char> seen(volume.brick_grid());
  const glm::ivec3 all = (volume.brick_grid() + 7) / 8;
  std::vector<glm::ivec3> every;
  for (int z = 0; z < all.z; ++z)
    for (int y = 0; y < all.y; ++y)
      for (int x = 0; x < all.x; ++x) every.emplace_back(x, y, z);
  seen.allocate(every);
  each([&](const glm::ivec3& v) {
    const glm::ivec3 brick = v / BrickVolume<glm::vec4>::side;
    if (texel(v) == glm::vec4(0.0f) || seen(brick)) return;
    seen(brick) = 1;
    bricks.push_back(brick);
  });
  volume.allocate(bricks);
  each([&](const glm::ivec3& v) {
    if (seen(v / BrickVolume<glm::vec4>::side)) volume(v) = texel(v);
  });
  return volume;
}

inline Medium fill_medium(const glm::ivec3& size, const std::function<glm::vec4(const glm::ivec3&)>& texel) {
  return make_medium(mipmap(unit_grid(size), fill(size, texel), MipmapOptions{}));
}

/// Whether v lies on the innermost of the layers of a closed box's walls: `margin` voxels in from the grid's border.
inline bool on_box(const glm::ivec3& v, const glm::ivec3& size, int margin) {
  bool inside = true, wall = false;
  for (int axis = 0; axis < 3; ++axis) {
    const int low = v[axis] - margin, high = size[axis] - 1 - margin - v[axis];
    inside = inside && low >= 0 && high >= 0;
    wall = wall || low == 0 || high == 0;
  }
  return inside && wall;
}

/// The inner walls of a closed box, one voxel thick and one voxel in from the border, with inward normals.
inline SurfaceGrid box_surfaces(const glm::ivec3& size, float albedo) {
  SurfaceGrid surfaces;
  surfaces.grid = unit_grid(size);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const glm::ivec3 v(x, y, z);
        if (!on_box(v, size, 1)) continue;
        glm::vec3 normal(0.0f);
        for (int axis = 0; axis < 3; ++axis) normal[axis] = float(v[axis] == 1) - float(v[axis] == size[axis] - 2);
        surfaces.voxels.push_back(v);
        surfaces.albedo.emplace_back(albedo, albedo, albedo, 1.0f);
        surfaces.normal.push_back(glm::normalize(normal));
        surfaces.centroid.push_back(surfaces.grid.center(v));
      }
  return surfaces;
}

}  // namespace voxref
