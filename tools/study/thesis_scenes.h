#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "study/study.h"

namespace voxref {

/// The thesis's scenes with Buddha, Dragon and Bunny as dynamic objects, whose specular cones are 45, 27 and 9 degrees
/// wide: cornell_box, and cornell_box_empty without blocks and objects, and unless the request is quick sibenik,
/// conference and sponza. The public ones and the objects come from request.assets. Not lit yet: see light_scenes.
/// @param skipped gets what is left out, once each, and why
std::vector<StudyScene> thesis_scenes(const StudyRequest& request, std::vector<std::string>& skipped);

/// Which light a test of the thesis uses.
enum class ThesisLight : uint8_t { sun, point };
/// Gives scenes of thesis_scenes the one light in place of what they had.
void light_scenes(std::vector<StudyScene>& scenes, ThesisLight light);

/// Scenes of emissive objects and no lamp: a white teapot on a floor among two blocks (figure 4.33), the empty Cornell
/// box with coloured balls and, where `scenes` has it, sponza with such (figure 4.34), a block between two coloured
/// balls (figure 4.35).
std::vector<StudyScene> glowing_scenes(const std::vector<StudyScene>& scenes);

/// The Cornell box with a specular ball in place of its blocks. @param degrees half-angle of its specular cone
StudyScene specular_ball(float degrees);

}  // namespace voxref
