#pragma once
// Meshes as scenes, for the tests of this folder.
#include "make_scenes/assemble.h"
#include "make_scenes/shapes.h"
#include "voxel/grid.h"

/// A scene of one mesh with one material.
inline voxref::Scene scene_of(const voxref::Mesh& mesh,
                              const voxref::Material& material = voxref::lambertian("grey", glm::vec3(0.5f))) {
  voxref::Scene scene;
  voxref::add_object(scene, "mesh", mesh, voxref::add_material(scene, material));
  return scene;
}

/// A grid of unit voxels from the origin: voxel coordinates are world coordinates, and dyadic data stay exact.
inline voxref::Grid unit_grid(const glm::ivec3& size) { return {size, glm::vec3(0.0f), 1.0f}; }
