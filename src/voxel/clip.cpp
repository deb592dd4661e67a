#include "voxel/clip.h"

#include <glm/geometric.hpp>

namespace voxref {

namespace {

/// Where an edge meets a plane; the same point whichever way the edge is walked, so that neighbours share it.
ClipVertex intersection(const ClipVertex& below, const ClipVertex& above, int axis, double plane) {
  const double t = (plane - below.position[axis]) / (above.position[axis] - below.position[axis]);
  ClipVertex vertex{below.position + t * (above.position - below.position), below.uv + t * (above.uv - below.uv)};
  vertex.position[axis] = plane;
  return vertex;
}

}  // namespace

double ClipPolygon::lowest(int axis) const {
  double result = vertices_[0].position[axis];
  for (int i = 1; i < count_; ++i) result = std::min(result, vertices_[i].position[axis]);
  return result;
}

double ClipPolygon::highest(int axis) const {
  double result = vertices_[0].position[axis];
  for (int i = 1; i < count_; ++i) result = std::max(result, vertices_[i].position[axis]);
  return result;
}

glm::dvec3 twice_vector_area(const ClipPolygon& polygon) {
  glm::dvec3 sum(0.0);
  for (int i = 2; i < polygon.size(); ++i)
    sum += glm::cross(polygon[i - 1].position - polygon[0].position, polygon[i].position - polygon[0].position);
  return sum;
}

void split(const ClipPolygon& polygon, int axis, double plane, ClipPolygon& below, ClipPolygon& above) {
  below.clear();
  above.clear();
  for (int i = 0; i < polygon.size(); ++i) {
    const ClipVertex& a = polygon[i];
    const ClipVertex& b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double from = a.position[axis] - plane, to = b.position[axis] - plane;
    if (from <= 0.0) below.add(a);
    if (from >= 0.0) above.add(a);
    if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
      const ClipVertex cut = from < 0.0 ? intersection(a, b, axis, plane) : intersection(b, a, axis, plane);
      below.add(cut);
      above.add(cut);
    }
  }
}

ClipPolygon clip_to_box(const ClipPolygon& polygon, const glm::dvec3& low, const glm::dvec3& high) {
  ClipPolygon rest = polygon, below, above;
  for (int axis = 0; axis < 3 && !rest.empty(); ++axis) {
    if (rest.lowest(axis) < low[axis]) {
      split(rest, axis, low[axis], below, above);
      rest = above;
    }
    if (!rest.empty() && rest.highest(axis) > high[axis]) {
      split(rest, axis, high[axis], below, above);
      rest = below;
    }
  }
  return rest;
}

}  // namespace voxref
