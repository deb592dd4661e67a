#include "voxel/triangle_bins.h"

#include <glm/geometric.hpp>
#include <limits>

#include "parallel.h"
#include "voxel/brick_volume.h"

namespace voxref {

namespace {

constexpr int side = BrickVolume<float>::side;
constexpr size_t triangles_per_chunk = 1024;

struct Entry {
  size_t brick;
  uint32_t triangle;
};

/// A corner is uncertain by rounding of its own coordinates and of the grid's origin and voxel size, which the distance
/// from the origin multiplies: two units in the last place of each.
double rounding_in_voxels(const Grid& grid) {
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double across = std::abs(double(grid.min[axis])) / grid.voxel;
    largest = std::max(largest, across + 2.0 * grid.size[axis]);
  }
  return 2.0 * std::numeric_limits<float>::epsilon() * largest;
}

}  // namespace

VoxelTriangles::VoxelTriangles(const Scene& scene, const Grid& grid)
    : scene_(scene), grid_(grid), rounding_(rounding_in_voxels(grid)) {}

ClipPolygon VoxelTriangles::operator()(uint32_t triangle) const {
  static constexpr glm::dvec2 barycentric[3] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  ClipPolygon polygon;
  for (int corner = 0; corner < 3; ++corner) {
    const glm::dvec3 world(scene_.positions[scene_.triangles[triangle][corner]]);
    glm::dvec3 position = (world - glm::dvec3(grid_.min)) / double(grid_.voxel);
    for (int axis = 0; axis < 3; ++axis) {
      const double face = std::round(position[axis]);
      if (std::abs(position[axis] - face) <= rounding_) position[axis] = face;
    }
    polygon.add({position, barycentric[corner]});
  }
  return polygon;
}

TriangleBins bin_triangles(const VoxelTriangles& triangles, const std::vector<bool>& chosen, const Progress& progress) {
  const size_t count = chosen.size();
  const glm::ivec3 size = triangles.grid().size, bricks = (size + side - 1) / side;
  std::vector<std::vector<Entry>> chunks((count + triangles_per_chunk - 1) / triangles_per_chunk);
  parallel_for(count, triangles_per_chunk, [&](size_t begin, size_t end) {
    progress.check();
    std::vector<Entry>& entries = chunks[begin / triangles_per_chunk];
    for (size_t t = begin; t < end; ++t) {
      if (!chosen[t]) continue;
      const ClipPolygon polygon = triangles(uint32_t(t));
      const glm::dvec3 area = twice_vector_area(polygon);
      if (!(glm::dot(area, area) > 0.0)) continue;
      const ClipPolygon inside = clip_to_box(polygon, glm::dvec3(0.0), glm::dvec3(size));
      if (inside.empty()) continue;
      for_each_cell(inside, side, glm::ivec3(0), bricks, [&](const glm::ivec3& brick, const ClipPolygon&, double) {
        entries.push_back({size_t(brick.x) + size_t(bricks.x) * (brick.y + size_t(bricks.y) * brick.z), uint32_t(t)});
      });
    }
  });

  // Counting sort by brick; chunk after chunk, so that triangles stay in order.
  std::vector<size_t> next(size_t(bricks.x) * size_t(bricks.y) * size_t(bricks.z));
  for (const auto& entries : chunks)
    for (const Entry& entry : entries) ++next[entry.brick];
  TriangleBins result;
  size_t total = 0, index = 0;
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x, ++index) {
        const size_t inside = next[index];
        next[index] = total;
        if (inside > 0) result.bins.push_back({{x, y, z}, total, total + inside});
        total += inside;
      }
  result.triangles.resize(total);
  for (auto& entries : chunks) {
    for (const Entry& entry : entries) result.triangles[next[entry.brick]++] = entry.triangle;
    entries = std::vector<Entry>();  // {} would keep the memory
  }
  return result;
}

}  // namespace voxref
