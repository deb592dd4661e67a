#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "options.h"
#include "reference/path.h"
#include "scene/scene.h"
#include "settings.h"

namespace voxref {

/// The program's version and that of the libraries it was built with.
std::string version();

/// Quoted for a shell where it needs to be, so that a command line can be run again.
std::string shell_word(const std::string& argument);

/// The processor's name, as the system tells it.
std::string cpu_model();

/// Remembers how the program was called.
void set_command_line(int argc, char* argv[]);

/// The part of it that does not depend on a scene: version, libraries, command line.
nlohmann::json program_provenance();

/// Where a result comes from, one object for image headers and reports: version, libraries, command line, scene and its
/// SHA-256, size and camera.
nlohmann::json provenance(const Scene& scene, const View& view);

/// What a command line changes in a scene as it is loaded, as far as the path tracer sees it; null where not given.
nlohmann::json describe(const SceneOptions& options);
/// All that the pixels depend on, null where not given.
nlohmann::json describe(const PathOptions& options);
/// Adds `seed`, `spp`, the samples that were taken, and `path`, describe(options).
void add_path_provenance(nlohmann::json& provenance, const PathOptions& options, int spp);

/// Puts every key into the header as the string attribute `voxref:KEY`.
void attach(Image& image, const nlohmann::json& provenance);

}  // namespace voxref
