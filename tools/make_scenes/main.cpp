#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "error.h"
#include "make_scenes/catalog.h"
#include "make_scenes/gltf_writer.h"

namespace voxref {
namespace {

const SceneEntry& find_entry(const std::string& name) {
  const auto& all = scene_catalog();
  const auto found = std::find_if(all.begin(), all.end(), [&](const SceneEntry& e) { return e.name() == name; });
  if (found == all.end()) throw Error(name, "no scene has this name; --list shows them all");
  return *found;
}

void write(const std::filesystem::path& file, const Scene& scene, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw Error(file.parent_path().string(), error.message());
  write_glb(file, scene, text);
  fmt::print("{}: {} triangles\n", file.string(), scene.triangles.size());
}

int run(int argc, char* argv[]) {
  CLI::App app("Writes the project's own scenes as .glb files.\nExample: make_scenes out thin_wall --thickness 0.005",
               "make_scenes");
  std::string folder;
  std::vector<std::string> names;
  bool list = false;
  SceneParameters parameters;
  app.add_option("DIR", folder, "Where the files go");
  app.add_option("NAME", names, "Which ones, as --list names them without .glb; all by default");
  app.add_flag("--list", list, "Print the table of all scenes and stop");
  app.add_option("--subdivisions", parameters.subdivisions, "Spheres have 20 x 4^N triangles, N in [0, 8]");
  app.add_option("--segments", parameters.segments, "Around cone, cylinder and torus, in [3, 4096]");
  app.add_option("--divisions", parameters.divisions, "Per side of each of the teapot's patches, in [2, 64]");
  app.add_option("--thickness", parameters.thickness, "Of the thin wall in metres, in (0, 1]");
  app.add_option("--albedo", parameters.albedo, "Of the furnaces, in [0, 1)");
  app.add_option("--scale", parameters.scale, "Multiplies every length; radiance and irradiance stay");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw Error("command line", error.what());
  }

  if (list) {
    for (const SceneEntry& entry : scene_catalog()) fmt::print("{}\n", table_row(entry));
    return 0;
  }
  if (folder.empty()) throw Error("DIR", "says where the files go and is missing");
  if (names.empty())
    for (const SceneEntry& entry : scene_catalog()) names.push_back(entry.name());
  std::vector<Scene> scenes(names.size());  // all are built, names and parameters checked, before anything is written
  for (size_t i = 0; i < names.size(); ++i) scenes[i] = build_scene(find_entry(names[i]), parameters);
  for (size_t i = 0; i < names.size(); ++i) {
    const SceneEntry& entry = find_entry(names[i]);
    write(std::filesystem::path(folder) / entry.file, scenes[i], description(entry, parameters));
  }
  return 0;
}

}  // namespace
}  // namespace voxref

int main(int argc, char* argv[]) {
  try {
    return voxref::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "make_scenes: {}\n", error.what());
    return 2;
  }
}
