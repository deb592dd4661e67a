#pragma once
#include <vector>

#include "scene/gltf_document.h"
#include "scene/material.h"

namespace voxref {

/// All materials of the document. A default-constructed Material is glTF's for primitives that name none.
/// @param light_scale multiplies emission
/// @throws Error FILE: PLACE: what
std::vector<Material> read_materials(GltfDocument& document, float light_scale);

}  // namespace voxref
