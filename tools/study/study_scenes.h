#pragma once
#include <optional>

#include "study/study.h"

namespace voxref {

/// Scenes that studies use when none are given. The project's own are made in memory, as `scenes/` holds them.
StudyScene cornell_point_scene();
StudyScene light_box_scene();
StudyScene plane_test_scene();

/// One of the larger public scenes, with a camera inside and one point light, or a sun: sponza, sibenik, conference.
/// @param assets the folder that holds `assets/` @returns none where the file is absent
std::optional<StudyScene> public_scene(const std::string& name, const std::filesystem::path& assets, bool sun);

/// The same camera with an image of this width and the camera's aspect.
View sized(View view, int width);

}  // namespace voxref
