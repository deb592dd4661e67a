#pragma once
#include "make_scenes/mesh.h"

// Shapes have their front outside and are centred at the origin unless said.
namespace voxref {

/// A quadrilateral, counter-clockwise seen from the front, cut along a-c. A twisted one (its corners in no plane) gets
/// six vertices, so that each triangle has its own normal; a flat one four.
Mesh quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);
/// An axis-aligned box with flat faces: 24 vertices, 12 triangles.
Mesh box(const glm::vec3& min, const glm::vec3& max);
/// A square of the given side in the plane y = 0, front upwards.
Mesh plane(float side);

/// Twenty flat faces, vertices at distance 1.
Mesh icosahedron();
/// The icosahedron with every edge halved `subdivisions` times and its vertices pushed out to distance 1: 20 x 4^n
/// triangles, smooth normals. @throws Error unless subdivisions is in [0, 8]
Mesh icosphere(int subdivisions);
/// A convex body between a sphere (power 2) and a box: |x|^p + |y|^p + |z|^p = 1, scaled to `half_extent`. The vertices
/// of an octahedron whose edges are halved `subdivisions` times, projected to it, and their convex hull: 8 x 4^n
/// triangles that hide nothing from one another; smooth normals, from the gradient.
Mesh rounded_box(const glm::vec3& half_extent, float power, int subdivisions);

/// Bodies of revolution about +Y, smooth around and sharp at the rims; `segments` (at least 3) around the axis.
Mesh cone(float radius, float height, int segments);      ///< apex up, closed by a base: 2 segments triangles
Mesh cylinder(float radius, float height, int segments);  ///< closed by two caps: 4 segments triangles
/// Radii of the ring's centre line and of its tube; `sides` around the tube: 2 segments sides triangles.
Mesh torus(float ring_radius, float tube_radius, int segments, int sides);

}  // namespace voxref
