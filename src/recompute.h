#pragma once
#include <filesystem>
#include <glm/vec3.hpp>

#include "compare/volume_diff.h"
#include "progress.h"
#include "scene/scene.h"
#include "settings.h"

namespace voxref {

/// Holds every stage of somebody else's pipeline against what voxref computes on that stage's own input, so that one
/// mistake is reported where it is made and not in all that follows from it: albedo, normal and emission against the
/// scene in the folder's grid, radiance against those, aniso_* against radiance, radiance_bounce against all of these,
/// aniso_bounce_* against radiance_bounce.
///
/// A volume's stage follows from its name. Volumes of averaged fragments (voxelize.average running_floor8) are accepted
/// in any order of averaging. A level that voxref does not make differs; emission that it does not make is 0; other
/// volumes that it does not make, and those whose stage's input is not there, are listed as missing.
/// @param under_test a folder of volumes, finite
/// @param work an existing folder for voxref's own volumes, to which the result refers
/// @return the volumes of `under_test` as the first side, voxref's as the second
/// @throws Error where nothing could be compared
FolderDifference recompute(const std::filesystem::path& under_test, const Scene& scene, const Settings& settings,
                           const glm::vec3& background, const VolumeLimits& limits, const std::filesystem::path& work,
                           const Progress& progress = {});

}  // namespace voxref
