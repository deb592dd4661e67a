#include "inputs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "error.h"
#include "json_members.h"

namespace voxref {

namespace {

/// By name first: a camera may be called "2".
const Camera& find_camera(const Scene& scene, const std::string& wanted) {
  for (const Camera& camera : scene.cameras)
    if (camera.name == wanted) return camera;
  size_t index = 0;
  const char* end = wanted.data() + wanted.size();
  const auto [rest, status] = std::from_chars(wanted.data(), end, index);
  if (status == std::errc() && rest == end && index < scene.cameras.size()) return scene.cameras[index];
  std::string names;
  for (const Camera& camera : scene.cameras) names += (names.empty() ? "" : ", ") + camera.name;
  throw Error("--camera", fmt::format("the scene has no camera '{}'; it has {}{}{}", wanted, scene.cameras.size(),
                                      names.empty() ? "" : ": ", names));
}

Camera choose_camera(const ViewOptions& options, const Scene& scene) {
  if (options.eye.has_value() != options.target.has_value())
    throw Error(options.eye ? "--target" : "--eye", "needed too: a camera of one's own has both");
  if (options.eye && options.camera) throw Error("--camera", "contradicts --eye and --target");
  if (options.up && !options.eye) throw Error("--up", "needs --eye and --target");
  if (options.eye) {
    constexpr float usual_yfov = 45.0f;
    return look_at(*options.eye, *options.target, options.up.value_or(glm::vec3(0.0f, 1.0f, 0.0f)),
                   glm::radians(options.yfov.value_or(usual_yfov)));
  }
  Camera camera = options.camera          ? find_camera(scene, *options.camera)
                  : scene.cameras.empty() ? framing_camera(scene)
                                          : scene.cameras.front();
  if (options.yfov) {
    if (camera.orthographic) throw Error("--yfov", "the camera is orthographic");
    camera.yfov = glm::radians(*options.yfov);
  }
  return camera;
}

}  // namespace

Scene load_scene(const SceneOptions& options, Terminal& terminal) {
  Scene scene = load_gltf(options.file, options.load);
  for (Light sun : options.suns) {
    sun.intensity *= options.load.light_scale;
    scene.lights.push_back(sun);
  }
  for (const std::string& warning : scene.warnings) terminal.warn("voxref: warning: " + warning);
  return scene;
}

size_t path_bytes_per_pixel(const PathOptions& options) {
  // While it renders: sums in float64 (Film::Pixel, 256 bytes), the running pass (PixelBatch, 68), and at the end the
  // image of 25 float32 channels. Writing the file needs less: sums and pass are gone, a second image is there.
  constexpr size_t film = 256, pass = 68, image = 4 * 25;
  constexpr size_t extra_layer = 3 * (8 + 4 + 4);  // the same three, of one colour
  return film + pass + image + extra_layer * options.extra.count();
}

void require_memory(const std::string& place, const View& view, size_t bytes_per_pixel) {
  const double needed = static_cast<double>(bytes_per_pixel) * view.width * view.height;
  const double installed = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  if (needed > installed)
    throw Error(place, fmt::format("{}x{} needs {:.0f} GiB of memory, the machine has {:.0f}", view.width, view.height,
                                   std::ldexp(needed, -30), std::ldexp(installed, -30)));
}

View make_view(const ViewOptions& options, const Scene& scene, size_t bytes_per_pixel) {
  View view;
  view.camera = choose_camera(options, scene);
  view.pixel = options.pixel;
  view.background = options.background;
  if (options.size) {
    view.width = options.size->x;
    view.height = options.size->y;
  } else {
    constexpr float usual_width = 512;
    const float height = std::clamp(std::round(usual_width / view.camera.aspect), 1.0f, 65536.0f);
    view.width = static_cast<int>(usual_width);
    view.height = static_cast<int>(height);
  }
  require_memory("--size", view, bytes_per_pixel);
  return view;
}

Settings make_settings(const SettingsOptions& options) {
  Settings settings;
  try {
    settings = profile(options.profile);
  } catch (const Error& error) {
    throw Error("--profile", error.what());
  }
  if (!options.config.empty()) {
    try {
      apply_json(settings, read_json(options.config));
    } catch (const Error& error) {
      const bool named = std::string_view(error.what()).starts_with(options.config);
      throw named ? error : Error(options.config, error.what());
    }
  }
  for (const std::string& assignment : options.assignments) {
    try {
      apply_assignment(settings, assignment);
    } catch (const Error& error) {
      throw Error("--set", error.what());
    }
  }
  validate(settings);
  return settings;
}

}  // namespace voxref
