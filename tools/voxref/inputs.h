#pragma once
#include "options.h"
#include "terminal.h"

namespace voxref {

// From flags to what the renderers take.

/// Loads the scene, adds its suns, and says what was ignored in it.
Scene load_scene(const SceneOptions& options, Terminal& terminal);

/// The camera that was asked for, else the scene's first, else one that frames the scene. @throws Error, also when the
/// machine has less memory than an image of `bytes_per_pixel` needs
View make_view(const ViewOptions& options, const Scene& scene, size_t bytes_per_pixel);
/// An image that cannot fit into the machine's memory is refused before the system ends the program for it.
/// @param place what gave the size, for the message @throws Error
void require_memory(const std::string& place, const View& view, size_t bytes_per_pixel);
/// The most memory that a renderer holds at once, from its image's first pixel to the written file.
size_t path_bytes_per_pixel(const PathOptions& options);
/// The image, and its copy in the order of the file.
constexpr size_t cone_bytes_per_pixel = 2 * cone_image_bytes_per_pixel;
/// What a renderer starts from: the scene, what is seen of it, and what casts rays into it.
struct OpenedScene {
  /// @throws Error as load_scene and make_view
  OpenedScene(const SceneOptions& file, const ViewOptions& look, size_t bytes_per_pixel, Terminal& terminal)
      : scene(load_scene(file, terminal)), view(make_view(look, scene, bytes_per_pixel)), caster(scene) {}
  OpenedScene(const OpenedScene&) = delete;  // the caster keeps a reference to the scene

  Scene scene;
  View view;
  Caster caster;
};

/// The profile, then the file, then the assignments. @throws Error with the file or flag, and the parameter
Settings make_settings(const SettingsOptions& options);

}  // namespace voxref
