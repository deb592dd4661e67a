#pragma once
#include <optional>
#include <span>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/gltf_nodes.h"

namespace voxref {

/// Checks all animations and marks the nodes that they target dynamic. With a time, in seconds, sets those nodes'
/// translation, rotation and scale: before the first key its value, after the last key its value; between keys STEP,
/// LINEAR (spherical for rotations) or CUBICSPLINE as glTF 2.0, appendix C, defines them. All animations of the file
/// play at once; where several move the same property the last one counts. @throws Error FILE: PLACE: what
void animate(GltfDocument& document, std::span<const GltfAccessor> accessors, std::vector<GltfNode>& nodes,
             std::optional<double> time);

}  // namespace voxref
