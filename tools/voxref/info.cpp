#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "commands.h"
#include "inputs.h"
#include "json.h"
#include "parallel.h"
#include "summary.h"
#include "volume_bytes.h"

namespace voxref {

namespace {

const std::set<int> usual_resolutions = {64, 128, 256, 512};

struct Options {
  CommonOptions common;
  SceneOptions scene;
  SettingsOptions settings;
};

/// What the pipeline would hold at one resolution.
struct VolumeNeed {
  int resolution = 0;
  Grid grid;
  size_t voxels = 0;  ///< occupied
  VolumeBytes bytes;
};

/// The scene's shape alone: where surface is does not depend on textures but for the holes of masks, and filtering them
/// takes nearly all the time.
Scene without_textures(const Scene& scene) {
  Scene plain = scene;
  const auto masked = [](const Material& material) { return material.alpha_mode == AlphaMode::mask; };
  if (std::ranges::none_of(plain.materials, masked)) plain.colors = {};  // their alpha makes holes too
  for (Material& material : plain.materials) {
    const TextureBinding mask = masked(material) ? material.base_color_texture : TextureBinding();
    Material shape;
    shape.base_color = material.base_color;
    shape.base_color_texture = mask;
    shape.alpha_mode = material.alpha_mode;
    shape.alpha_cutoff = material.alpha_cutoff;
    shape.emission = material.emission;  // whether there is any decides about a volume
    material = shape;
  }
  return plain;
}

VolumeNeed measure(const Scene& scene, Settings settings, int resolution, const Progress& progress) {
  settings.grid.resolution = resolution;
  const Grid grid = fit_grid(scene.bounds(), settings.grid);
  const SurfaceGrid surfaces = voxelize(scene, grid, settings.voxelize, progress);
  return {resolution, grid, surfaces.size(), predict_bytes(surfaces, settings)};
}

nlohmann::json describe(const VolumeNeed& need) {
  return {{"resolution", need.resolution},
          {"grid", {need.grid.size.x, need.grid.size.y, need.grid.size.z}},
          {"voxel", need.grid.voxel},
          {"voxels_occupied", need.voxels},
          {"bytes", need.bytes}};
}

std::string bytes_of(const VolumeNeed& need) {
  std::string text;
  for (const auto& [volume, bytes] : need.bytes)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", volume, byte_count(bytes));
  return text;
}

template <class Named>
nlohmann::json names(const std::vector<Named>& things) {
  nlohmann::json list = nlohmann::json::array();
  for (const Named& thing : things) list.push_back(thing.name);
  return list;
}

std::string joined(const nlohmann::json& list) {
  std::string text;
  for (const auto& name : list) text += (text.empty() ? ": " : ", ") + name.get<std::string>();
  return text;
}

void say(Terminal& terminal, const Scene& scene, const std::vector<VolumeNeed>& needs) {
  const Bounds bounds = scene.bounds();
  const auto line = [&](const char* what, const std::string& value) {
    terminal.say(fmt::format("{:<10}{}", what, value));
  };
  line("triangles", fmt::format("{} in {} objects", scene.triangles.size(), scene.objects.size()));
  line("vertices", std::to_string(scene.positions.size()));
  line("materials", std::to_string(scene.materials.size()));
  line("textures", std::to_string(scene.images.size()));
  line("lights", std::to_string(scene.lights.size()) + joined(names(scene.lights)) +
                     (scene.has_emission() ? "; some surfaces emit" : ""));
  line("cameras", std::to_string(scene.cameras.size()) + joined(names(scene.cameras)));
  if (!bounds.empty())
    line("bounds", fmt::format("{:g} {:g} {:g} to {:g} {:g} {:g}", bounds.min.x, bounds.min.y, bounds.min.z,
                               bounds.max.x, bounds.max.y, bounds.max.z));
  for (const VolumeNeed& n : needs)
    line(n.resolution == needs.front().resolution ? "volumes" : "",
         fmt::format("{:>4}: {}x{}x{}, {} voxels occupied; {}", n.resolution, n.grid.size.x, n.grid.size.y,
                     n.grid.size.z, n.voxels, bytes_of(n)));
}

int run_info(const Options& options) {
  const Settings settings = make_settings(options.settings);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const Scene scene = load_scene(options.scene, terminal);
  std::vector<VolumeNeed> needs;
  std::set<int> resolutions = usual_resolutions;
  resolutions.insert(settings.grid.resolution);
  // The published shaders look every texture up: a texel's alpha of 0 writes nothing.
  const Scene shape = settings.voxelize.method == VoxelizeMethod::exact ? without_textures(scene) : scene;
  for (const int resolution : resolutions) needs.push_back(measure(shape, settings, resolution, terminal.progress()));
  say(terminal, scene, needs);

  const Bounds bounds = scene.bounds();
  nlohmann::json volumes = nlohmann::json::array();
  for (const VolumeNeed& need : needs) volumes.push_back(describe(need));
  terminal.result(
      {{"triangles", scene.triangles.size()},
       {"vertices", scene.positions.size()},
       {"objects", scene.objects.size()},
       {"materials", scene.materials.size()},
       {"textures", scene.images.size()},
       {"lights", names(scene.lights)},
       {"emissive", scene.has_emission()},
       {"cameras", names(scene.cameras)},
       {"bounds", bounds.empty() ? nlohmann::json() : nlohmann::json{to_json(bounds.min), to_json(bounds.max)}},
       {"sha256", scene.sha256},
       {"warnings", scene.warnings},
       {"volumes", volumes}});
  return exit_done;
}

}  // namespace

void add_info(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("info", "what is in a scene, and the memory that its volumes need");
  const auto options = std::make_shared<Options>();
  add_scene_options(*command, options->scene);
  add_settings_options(*command, options->settings);
  add_common_options(*command, options->common);
  command->footer(
      "The volumes are counted by voxelizing the scene with 64, 128, 256 and 512 voxels along its longest side, and\n"
      "with grid.resolution where that is another number; `total` is the most that `voxref cone` holds of them at\n"
      "once with the same settings.\n\n"
      "Example:\n  voxref info scenes/cornell_box.glb --set storage=float16");
  on_run(command, run, [options] { return run_info(*options); });
}

}  // namespace voxref
