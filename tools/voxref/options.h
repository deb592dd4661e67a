#pragma once
#include <CLI/App.hpp>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline.h"
#include "reference/path.h"
#include "scene/camera.h"
#include "scene/gltf.h"
#include "settings.h"

namespace voxref {

// The flags that commands share. Every wrong value throws Error `FLAG: what is wrong`.

struct CommonOptions {
  int threads = 0;     ///< 0: all cores
  bool quiet = false;  ///< neither progress nor summary
  bool json = false;   ///< the result as one JSON object on stdout, everything else on stderr
};

struct SceneOptions {
  std::string file;
  LoadOptions load;
  std::vector<Light> suns;  ///< directional lights beside the file's own, before the light scale
};

struct ViewOptions {
  std::optional<glm::ivec2> size;
  std::optional<std::string> camera;         ///< name or index
  std::optional<glm::vec3> eye, target, up;  ///< a camera of one's own
  std::optional<float> yfov;                 ///< degrees
  PixelSampling pixel = PixelSampling::center;
  glm::vec3 background{0.0f};
};

struct SettingsOptions {
  std::string profile = "radiometric";
  std::string config;                    ///< file; empty: none
  std::vector<std::string> assignments;  ///< key=value
};

/// What every command takes that makes images: path, cone, check and stage.
struct RenderCommandOptions {
  CommonOptions common;
  SceneOptions scene;
  ViewOptions view;
  std::string output;
};

/// What they take that cone trace.
struct ConeCommandOptions : RenderCommandOptions {
  SettingsOptions settings;
  ConeTraceOutputs outputs;
};

void add_common_options(CLI::App& command, CommonOptions& options);
/// The positional SCENE and add_loading_options.
void add_scene_options(CLI::App& command, SceneOptions& options);
/// What changes a scene as it is loaded.
void add_loading_options(CLI::App& command, SceneOptions& options);
/// The image's size and sampling, and add_camera_options.
void add_view_options(CLI::App& command, ViewOptions& options);
/// The camera and what surrounds the scene.
void add_camera_options(CLI::App& command, ViewOptions& options);
void add_path_options(CLI::App& command, PathOptions& options);
void add_settings_options(CLI::App& command, SettingsOptions& options);
/// All of RenderCommandOptions; in the help, what `add_own` adds stands behind SCENE and -o. @param what,help of -o
void add_render_options(CLI::App& command, RenderCommandOptions& options, const std::string& what,
                        const std::string& help, const std::function<void()>& add_own);
/// --volumes, a folder that is checked at once.
void add_volumes_option(CLI::App& command, ConeTraceOutputs& outputs);
/// The required -o. @param what "FILE" or "DIR"
void add_output_option(CLI::App& command, std::string& output, const std::string& what, const std::string& help);
/// A flag whose value `take` reads from the text that follows it.
void add_value_option(CLI::App& command, const std::string& flag, const std::string& value, const std::string& help,
                      const std::function<void(const std::string& text)>& take);

/// The work of the command that was given on the command line: returns the exit status.
using Run = std::function<int()>;
/// Makes `work` the program's run when `command` is given. @throws Error for arguments that the command does not know
void on_run(CLI::App* command, Run& run, const std::function<int()>& work);
/// @throws Error naming the first argument that nobody took, and the nearest flag
void refuse_leftovers(const CLI::App& command);

/// Checks before work begins that `folder` exists or could be made, and takes files. @throws Error with the path
void require_folder(const std::filesystem::path& folder);

}  // namespace voxref
