#pragma once
#include <cstdint>
#include <vector>

#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

struct BareRay {
  Ray ray;
  bool occlusion = false;  ///< for Caster::occluded() instead of closest()
};

/// Incoherent rays like those of a path tracer, made before any clock runs: from points spread evenly over the
/// surfaces, rays with a cosine-distributed direction (for closest()) and rays to a light (for occluded()), evenly
/// mixed.
/// @param occlusion_share of all rays, in [0,1) @throws Error when the scene has no surface, or no light for a share
/// above 0
std::vector<BareRay> incoherent_rays(const Scene& scene, const Caster& caster, size_t count, double occlusion_share);

/// Casts `count` rays, going round through `rays`, and does nothing else. @return seconds
double cast_seconds(const Caster& caster, const std::vector<BareRay>& rays, uint64_t count);

}  // namespace voxref
