#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace voxref {

struct LoadOptions {
  std::optional<double> time;        ///< seconds into the file's animations; none: they are ignored
  std::vector<std::string> dynamic;  ///< names of further nodes whose objects (and their descendants') are dynamic
  float light_scale = 1.0f;          ///< multiplies every light's intensity and all emission
};

/// Loads a glTF 2.0 file (.gltf or .glb) and checks it: every index, range, size and number that later stages rely on.
/// Extensions understood: KHR_lights_punctual, KHR_materials_emissive_strength, KHR_materials_specular,
/// KHR_materials_pbrSpecularGlossiness, KHR_texture_transform, KHR_mesh_quantization. A required extension that is not
/// among them is refused by name; optional ones, and features without meaning here, are listed in Scene::warnings.
/// @throws Error `FILE: PLACE: what is wrong`, PLACE being a JSON path such as `meshes[2].primitives[0].indices`
Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace voxref
