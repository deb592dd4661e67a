#pragma once
#include <string>
#include <vector>

#include "scene/caster.h"
#include "study/setting_space.h"

namespace voxref {

/// Whether a surface that the view sees sees another: 16,384 rays in cosine-distributed directions off what is under
/// 64 x 64 positions of the image, on the viewer's side. Where a thousandth of all such rays would meet a surface, one
/// scene in 10^7 passes for one that meets none.
bool view_sees_surfaces(const Scene& scene, const Caster& caster, const View& view);

/// Takes away what the scene cannot use, and says so in one line each. @param sees whether a surface in view gets light
/// from another: else bounces are dropped, and all but the fewest cones
std::vector<std::string> drop_unused(SettingSpace& space, const Scene& scene, bool sees, const glm::vec3& background);

}  // namespace voxref
