#pragma once
#include <optional>

#include "study/study.h"

namespace voxref {

/// A scene of that name, seen by the first of its cameras.
StudyScene seen_by_first_camera(const std::string& name, Scene scene);

/// Scenes that studies use when none are given. The project's own are made in memory, as `scenes/` holds them.
StudyScene cornell_point_scene();
StudyScene light_box_scene();
StudyScene plane_test_scene();

/// Where one stands in a public scene, whose file has neither camera nor light, metres, and what lights it: a lamp
/// between camera and target, bright enough for an irradiance of about 1 W/m^2 half-way across, or a sun through the
/// openings.
struct Standpoint {
  const char* name;
  glm::vec3 eye, target, lamp;
  float intensity;  ///< W/sr
};
/// @throws Error naming a scene that has none
const Standpoint& standpoint(const std::string& name);
/// @param irradiance of a facing surface, W/m^2
Light study_sun(float irradiance);

/// One of the larger public scenes, with a camera inside and one point light, or a sun: sponza, sibenik, conference.
/// @param assets the folder that holds `assets/` @returns none where the file is absent
std::optional<StudyScene> public_scene(const std::string& name, const std::filesystem::path& assets, bool sun);

/// The scenes that were asked for, else `own` and, unless the request is quick, sponza; what is left out is named in
/// `skipped`. @param sun what lights sponza, see public_scene
std::vector<StudyScene> scenes_or_own(const StudyRequest& request, std::vector<StudyScene> own, bool sun,
                                      std::vector<std::string>& skipped);

/// The same camera with an image of this width and the camera's aspect.
View sized(View view, int width);

}  // namespace voxref
