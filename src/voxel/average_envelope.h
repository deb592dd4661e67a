#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "progress.h"
#include "scene/scene.h"
#include "voxel/grid.h"

namespace voxref {

/// What a byte can become when its fragments are averaged in another order (see RunningAverage8): a GPU's is not fixed.
struct AverageEnvelope {
  uint8_t least = 0, greatest = 0;
  bool exact = true;  ///< both are reached by some order; else no order leads outside
  bool contains(uint8_t value) const { return value >= least && value <= greatest; }
};

/// Exact for up to 16 different fragments, and for more where many are equal. @param values the fragments' channel, 1
/// is 255; at least one
AverageEnvelope average_envelope(std::span<const float> values);

struct VoxelEnvelope {
  glm::ivec3 voxel{0};
  uint8_t count = 0;  ///< of fragments, modulo 256; the same in any order
  std::array<AverageEnvelope, 3> albedo, normal, emission;
};

/// The envelopes of all voxels that the raster voxelization writes, sorted z, y, x. @param static_wins as in
/// VoxelizeOptions; without it the envelope is that of static and dynamic fragments mixed in any order
std::vector<VoxelEnvelope> raster_envelopes(const Scene& scene, const Grid& grid, bool static_wins,
                                            const Progress& progress = {});

}  // namespace voxref
