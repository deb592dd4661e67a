#pragma once
#include <string>
#include <vector>

#include "study/study.h"

namespace voxref {

/// Which light a test of the thesis uses.
enum class ThesisLight : uint8_t { sun, point };

/// The thesis's scenes that are there (Sibenik, Cornell box, Conference, Sponza): Buddha, Dragon and Bunny stand in
/// them as dynamic objects whose specular cones are 45, 27 and 9 degrees wide. @param skipped gets what is absent
std::vector<StudyScene> thesis_scenes(const StudyRequest& request, ThesisLight light,
                                      std::vector<std::string>& skipped);

/// A glowing white teapot on a floor among two blocks, no lamp (figure 4.33).
StudyScene glowing_teapot();

/// The Cornell box with a specular ball in place of its blocks. @param degrees half-angle of its specular cone
StudyScene specular_ball(float degrees);

}  // namespace voxref
