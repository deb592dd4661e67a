#pragma once
#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace voxref {

/// Writes a scene as one .glb: a node per object, camera and light. Textures are not supported (no scene here has one).
/// @param description goes to asset.extras.description @throws Error with the path when it cannot be written
void write_glb(const std::filesystem::path& file, const Scene& scene, const std::string& description);

}  // namespace voxref
