#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace voxref {

/// The project's own scenes, made in memory in any size; catalog.h holds the one sentence and the known answer that
/// each carries as a file. Materials are Lambertian (metallic 0, specular 0) and surfaces face where one looks at them
/// unless said. Radiance and intensity are in W/(sr m^2) and W/sr, lengths in metres.

enum class CornellLight {
  area,  ///< the measured lamp, an emissive quad in a hole of the ceiling: nothing lies in one plane with it
  point  ///< a point light 0.1 m below the lamp's centre, as intense as the lamp is straight down; a whole ceiling
};
/// Cornell's measured box and blocks (Cornell University Program of Computer Graphics, Cornell Box Data) in metres, in
/// its own axes, open towards the camera at -Z; red on the left, green on the right. Colours: see CornellColors.
Scene cornell_box(CornellLight light, bool blocks = true);
/// The Cornell box, area light, with nine GGX spheres in place of the blocks: from the floor up rows of gold, of
/// dielectric and of half rough mixtures, their roughness 0.1, 0.4 and 0.8 from left to right.
Scene glossy_spheres();

/// Closed cube of side 2, seen from inside, with emission 1 and the given albedo everywhere: radiance 1 / (1 - albedo)
/// in every direction. @throws Error unless albedo is in [0, 1)
Scene furnace(float albedo);
/// Unit sphere of the given albedo, seen from inside, with a point light of 1 W/sr at its centre. An icosphere of
/// 20 x 4^subdivisions triangles, flat shaded, pushed out until its area is exactly 4 pi: all of the light's flux 4 pi
/// lands on it, so the mean irradiance over its surface is exactly 1 directly and 1 / (1 - albedo) in all, whatever the
/// tessellation, and the mean radiance albedo / (pi (1 - albedo)). Only the spread about that mean is the facets'.
/// @throws Error unless albedo is in [0, 1) and subdivisions in [0, 8]
Scene sphere_furnace(float albedo, int subdivisions);
/// A plane y = 0 of side 4 and albedo 0.5 under a point light of 1 W/sr at (0, 1, 0): radiance
/// albedo / pi x (1 + x^2 + z^2)^(-3/2).
Scene point_light_over_plane();
/// A plane y = 0 of side 4 and albedo 0.5 under a black square of side 1 at height 1 that emits radiance 1 downwards:
/// irradiance by Lambert's formula, 4 sqrt(1/5) atan(sqrt(1/5)) = 0.752275 below its centre; nothing is reflected
/// twice.
Scene rectangle_luminaire();

/// A white floor, cut by two sheets 2 mm apart in the plane x = 0: red to the left, green to the right, a point light
/// on either side. Light from the green sheet reaches nothing at x < 0, nor light from the red one anything at x > 0.
Scene red_green_wall();
/// A closed white room of 2 x 1 x 1 m cut in two by a wall across x = 0, a point light in the half x < 0: the other
/// half is black. Each half is a closed box of its own, so no seam lets light through. Cameras: `lit`, `dark`.
/// @param thickness of the wall, metres @throws Error unless it is in (0, 1]
Scene thin_wall(float thickness);
/// The thesis's Light Box: a closed white interior (albedo 0.8) with edges so smooth that nothing occludes, 4,098
/// vertices and 8,192 triangles, a low point light.
Scene light_box();
/// The thesis's Plane Test: a slab and a thin tall box in one corner of it, 24 triangles, under a directional light.
Scene plane_test();

/// How finely the round objects are cut.
struct ObjectDetail {
  int subdivisions = 3;  ///< of the sphere
  int segments = 64;     ///< around cone, cylinder and torus
  int teapot = 8;        ///< per side of each of the teapot's 32 patches
};
/// icosahedron, cube, sphere, cone, torus, plane, cylinder, teapot
const std::vector<std::string>& object_names();
/// One object on its own, about 1 m large, standing on y = 0 under a directional light. @throws Error otherwise
Scene single_object(const std::string& name, const ObjectDetail& detail = {});
/// All eight side by side on a plane.
Scene primitives(const ObjectDetail& detail = {});

}  // namespace voxref
