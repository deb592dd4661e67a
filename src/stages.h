#pragma once
#include <filesystem>
#include <glm/vec3.hpp>

#include "progress.h"
#include "scene/caster.h"
#include "scene/scene.h"
#include "settings.h"
#include "voxel/texel.h"
#include "voxel/volume_file.h"

namespace voxref {

// One stage of the pipeline alone, on volumes that somebody else made: a GPU, a test, another setting. Each writes what
// it makes, with its own volumes.json, into the folder `to`, and throws Error where `from` lacks what it needs.
// Those that make radiance return what the storage of the settings could not hold of it.

/// Scene -> albedo, normal, emission (and centroid) in the given grid.
void run_voxelize(const Scene& scene, const Grid& grid, const Settings& settings, const std::filesystem::path& to,
                  const Progress& progress);
/// albedo, normal, emission -> radiance, visibility
Clamping run_shade(const VolumeFolder& from, const Scene& scene, const Settings& settings,
                   const std::filesystem::path& to, const Progress& progress);
/// radiance, radiance_bounce, whichever are there -> aniso_*, aniso_bounce_*
void run_mipmap(const VolumeFolder& from, const Settings& settings, const std::filesystem::path& to,
                const Progress& progress);
/// albedo, normal, emission, radiance, and aniso_* where they are there (else they are made) -> radiance_bounce,
/// aniso_bounce_* @param background radiance from outside
Clamping run_bounce(const VolumeFolder& from, const Settings& settings, const glm::vec3& background,
                    const std::filesystem::path& to, const Progress& progress);

}  // namespace voxref
