#pragma once
#include <cstdint>
#include <vector>

#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

/// Incoherent rays like those of a path tracer, made before any clock runs: from points spread evenly over the
/// surfaces, one ray with a cosine-distributed direction (for closest()) and one to a light (for occluded()) in turn.
std::vector<Ray> incoherent_rays(const Scene& scene, const Caster& caster, size_t count);

/// Casts `count` rays, going round through `rays`, and does nothing else. @return seconds
double cast_seconds(const Caster& caster, const std::vector<Ray>& rays, uint64_t count);

}  // namespace voxref
