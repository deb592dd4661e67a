#pragma once
#include <cstddef>
#include <map>
#include <string>

#include "cone/gatherer.h"
#include "settings.h"

namespace voxref {

/// Bytes of each volume that there is: surfaces, radiance (direct, and after the bounces), visibility, shadow (what
/// shadows at the voxels are marched through), base, levels (all directional ones), occupancy, depths (held while
/// extinction is made ready), light_visibility (what pixel.shadow=visibility reads). `total` is the most that is held
/// at once.
using VolumeBytes = std::map<std::string, size_t>;

/// What the pipeline will allocate for these surfaces. Bricks follow from the occupied voxels alone.
VolumeBytes predict_bytes(const SurfaceGrid& surfaces, const Settings& settings);

/// Completes the sums over volumes.
void add_total(VolumeBytes& bytes, const Settings& settings);

}  // namespace voxref
