#pragma once
#include <string>

#include "scene/scene.h"

namespace voxref {

/// The project's own scenes, made in memory in any size. All materials are Lambertian (metallic 0, specular 0) unless said.
/// Each builder's comment is the one sentence that the file in scenes/ carries, with its known answer where there is one.

/// Cornell's measured box and blocks in metres, open towards the camera; reflectances and the light's radiance from
/// Cornell's published spectra converted to linear sRGB.
enum class CornellLight { area, point };
Scene cornell_box(CornellLight light, bool blocks = true);

/// The thesis's Light Box: a closed white interior with edges so smooth that nothing occludes, a low point light.
Scene light_box();
/// The thesis's Plane Test: a plane and a thin tall box in one corner, directional light.
Scene plane_test();
/// The seven primitives of the thesis and the teapot side by side on a plane.
Scene primitives();
/// One object on its own: icosahedron, cube, sphere, cone, torus, plane, cylinder or teapot. @throws Error otherwise
Scene single_object(const std::string& name);
/// Closed cube with emission 1 and the given albedo everywhere: radiance 1/(1-albedo) in every direction.
Scene furnace(float albedo);
/// Unit sphere of the given albedo, seen from inside, with a point light of 1 W/sr at its centre: radiance
/// albedo / (pi (1-albedo)) everywhere but for the facets. Icosphere, 20 x 4^subdivisions triangles.
Scene sphere_furnace(float albedo, int subdivisions);
/// Two walls back to back, red in front of green, thinner than a voxel: a ray from one side sees that side's colour only.
Scene red_green_wall();
/// A closed room cut in two by a wall of `thickness` metres, a point light in one half: the other half is black.
Scene thin_wall(float thickness);

}  // namespace voxref
