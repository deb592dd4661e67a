#pragma once
#include <cstdint>
#include <vector>

#include "scene/camera.h"
#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

struct BareRay {
  Ray ray;
  bool occlusion = false;  ///< for Caster::occluded() instead of closest()
};

/// Rays like those of a path tracer, in the order in which it would cast them one by one, made before any clock runs:
/// from what the centres of the view's pixels see, rays in cosine-distributed directions (for closest()), on to what
/// these hit and so on, as long as roulette with the surfaces' albedo lets them; and from the same points rays to a
/// light (for occluded()).
/// @param occlusion_share of all rays, in [0,1) @throws Error when the view shows no surface, or there is no light for
/// a share above 0
std::vector<BareRay> walk_rays(const Scene& scene, const Caster& caster, const View& view, size_t count,
                               double occlusion_share);

/// Casts `count` rays, going round through `rays`, and does nothing else. @return seconds
double cast_seconds(const Caster& caster, const std::vector<BareRay>& rays, uint64_t count);

/// Computes with all threads, without touching memory. @return seconds
double arithmetic_seconds();

}  // namespace voxref
