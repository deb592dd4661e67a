#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace voxref {

/// What may be varied when scene files are made; what is not given stays as in the committed files.
struct SceneParameters {
  std::optional<int> subdivisions;  ///< of spheres: 20 x 4^n triangles
  std::optional<int> segments;      ///< around cone, cylinder and torus
  std::optional<int> divisions;     ///< per side of each of the teapot's patches
  std::optional<float> thickness;   ///< of the thin wall, metres
  std::optional<float> albedo;      ///< of the furnaces
  float scale = 1.0f;               ///< of every length; lights keep their radiance and irradiance
};

/// A file of scenes/.
struct SceneEntry {
  std::string file;      ///< relative to scenes/
  std::string sentence;  ///< what it is
  std::string answer;    ///< what is known about its light in closed form; empty where nothing is
  std::function<Scene(const SceneParameters&)> build;

  std::string name() const { return file.substr(0, file.size() - 4); }  ///< without .glb
};

/// All files, in the order of scenes/README.md.
const std::vector<SceneEntry>& scene_catalog();

/// The entry's scene with all parameters applied, the scale too. @throws Error naming a parameter out of range
Scene build_scene(const SceneEntry& entry, const SceneParameters& parameters = {});

/// The same scene with every length times `factor`: radiance and irradiance stay, so intensities grow with its square.
/// @throws Error unless factor is finite and above 0
Scene scaled(Scene scene, float factor);

/// What the file says of itself: sentence, answer, and which parameters were given.
std::string description(const SceneEntry& entry, const SceneParameters& parameters = {});

/// A row of the table in scenes/README.md: file, sentence, triangles, known answer.
std::string table_row(const SceneEntry& entry);

}  // namespace voxref
