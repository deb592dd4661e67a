#pragma once
#include <glm/vec3.hpp>

#include "cone/gather.h"
#include "scene/caster.h"

namespace voxref {

/// How far the apex of a pixel's cones must move along the surface (world units) to stand off what else is near by as
/// much as it stands off the surface itself. Beside a concave edge, or where a block stands on a floor, it would
/// otherwise lie within the other wall's voxels, and every cone would see that wall and nothing else. Four short rays
/// look for neighbours; between walls that are too close for both, the apex clears the last one found.
/// @param normal unit, of the surface at `position`; both world @param voxel side of a voxel, world units
glm::vec3 clearance(const Scene& scene, const Caster& caster, const glm::vec3& position, const glm::vec3& normal,
                    const ConeOptions& options, float voxel);

}  // namespace voxref
