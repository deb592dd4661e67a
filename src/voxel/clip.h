#pragma once
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace voxref {

/// A corner of a piece of a triangle. Double precision: the pieces of a triangle shall sum to the triangle, and float32
/// would lose as many digits as there are voxels.
struct ClipVertex {
  glm::dvec3 position{0.0};  ///< in voxels
  glm::dvec2 uv{0.0};        ///< barycentric coordinates in the triangle, as in Hit
};

/// A convex piece of a triangle, its corners in the triangle's order.
class ClipPolygon {
 public:
  /// A triangle clipped against a brick and then against a voxel: every plane adds a corner at most.
  static constexpr int capacity = 3 + 6 + 6;

  void add(const ClipVertex& vertex) {
    assert(count_ < capacity);
    vertices_[count_++] = vertex;
  }
  void clear() { count_ = 0; }
  int size() const { return count_; }
  bool empty() const { return count_ < 3; }  ///< a point or an edge is no piece
  const ClipVertex& operator[](int i) const { return vertices_[i]; }
  double lowest(int axis) const;   ///< least coordinate; of a piece that is not empty
  double highest(int axis) const;  ///< greatest coordinate; of a piece that is not empty

 private:
  int count_ = 0;
  std::array<ClipVertex, capacity> vertices_;
};

/// Twice the vector area: its length is twice the area, its direction the triangle's front.
glm::dvec3 twice_vector_area(const ClipPolygon& polygon);

/// Cuts along the plane `axis` = `plane` (Sutherland and Hodgman 1974). What lies in the plane belongs to both sides.
void split(const ClipPolygon& polygon, int axis, double plane, ClipPolygon& below, ClipPolygon& above);

/// The part inside the closed box.
ClipPolygon clip_to_box(const ClipPolygon& polygon, const glm::dvec3& low, const glm::dvec3& high);

/// Cuts a polygon into the slabs [k side, (k+1) side] of an axis and calls visit(k, piece, share) for each slab with
/// first <= k < last that it reaches into. `share` is 1, or 1/2 where the whole polygon lies in the face of two slabs
/// and each gets half of its area. @param polygon inside [first side, last side]
template <class Visit>
void for_each_slab(const ClipPolygon& polygon, int axis, int side, int first, int last, Visit&& visit) {
  const double low = polygon.lowest(axis) / side, high = polygon.highest(axis) / side;
  const int begin = int(std::floor(low)), end = int(std::ceil(high));
  if (low == high && begin == end) {  // flat, and in a face
    if (begin - 1 >= first && begin - 1 < last) visit(begin - 1, polygon, 0.5);
    if (begin >= first && begin < last) visit(begin, polygon, 0.5);
    return;
  }
  ClipPolygon rest = polygon, below, above;
  for (int k = begin; k + 1 < end; ++k) {
    split(rest, axis, double(k + 1) * side, below, above);
    if (!below.empty()) visit(k, below, 1.0);
    rest = above;
  }
  if (!rest.empty()) visit(end - 1, rest, 1.0);
}

/// The same in three dimensions: calls visit(cell, piece, share) for each cubic cell of a box of cells.
template <class Visit>
void for_each_cell(const ClipPolygon& polygon, int side, const glm::ivec3& first, const glm::ivec3& last,
                   Visit&& visit) {
  for_each_slab(polygon, 2, side, first.z, last.z, [&](int z, const ClipPolygon& slab, double share_z) {
    for_each_slab(slab, 1, side, first.y, last.y, [&](int y, const ClipPolygon& row, double share_y) {
      for_each_slab(row, 0, side, first.x, last.x, [&](int x, const ClipPolygon& piece, double share_x) {
        visit(glm::ivec3(x, y, z), piece, share_x * share_y * share_z);
      });
    });
  });
}

}  // namespace voxref
