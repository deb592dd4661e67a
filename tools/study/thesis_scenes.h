#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "study/study.h"

namespace voxref {

/// The thesis's seven scenes with Buddha, Dragon and Bunny as dynamic objects, whose specular cones are 45, 27 and 9
/// degrees wide: cornell_box, and cornell_box_empty without its blocks, unless the request is quick sibenik, conference
/// and sponza, then light_box and plane_test. The public ones and the objects come from request.assets. How they are
/// lit is light_scenes' to say. @param skipped gets what is left out, once each, and why
std::vector<StudyScene> thesis_scenes(const StudyRequest& request, std::vector<std::string>& skipped);

/// Which light a test of the thesis uses.
enum class ThesisLight : uint8_t { sun, point };
/// Gives scenes of thesis_scenes the one light in place of what they had: a sun of irradiance 1 or a lamp of
/// intensity 1.
void light_scenes(std::vector<StudyScene>& scenes, ThesisLight light);

/// Scenes of emissive objects and no lamp: a white teapot on a floor among two blocks (figure 4.33), the empty Cornell
/// box with coloured balls and, where `scenes` has it, sponza with such (figure 4.34), a block between two coloured
/// balls (figure 4.35).
std::vector<StudyScene> glowing_scenes(const std::vector<StudyScene>& scenes);

/// Half-angle of the published specular cone of a material, degrees: its glossiness is kept in a byte.
float rendered_half_angle(const Material& material);

/// The Cornell box with a specular ball in place of its blocks. @param degrees half-angle of its specular cone, which a
/// byte tells to 0.18 degrees
StudyScene specular_ball(float degrees);

}  // namespace voxref
