#pragma once
#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace voxref {

/// A scene as the bytes of a .glb (glTF 2.0): a node per object, then per camera, then per light, in the scene's order;
/// every number as the shortest text that reads back as the same float. The same scene gives the same bytes.
/// Understands what the project's own scenes use: metallic-roughness materials, perspective cameras, point and
/// directional lights. @param description goes to asset.extras.description @throws Error naming what else the scene has
std::string glb(const Scene& scene, const std::string& description);

/// @throws Error with the path when it cannot be written; the file appears whole or not at all
void write_glb(const std::filesystem::path& file, const Scene& scene, const std::string& description);

}  // namespace voxref
