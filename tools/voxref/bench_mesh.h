#pragma once
#include "scene/scene.h"

namespace voxref {

/// Puts a wavy white ball of about 70,000 triangles in the middle of a scene, half as wide as the scene's shortest
/// side: work for rays that a box of a few walls does not give. @throws Error for a scene without extent
void add_mesh(Scene& scene);

}  // namespace voxref
