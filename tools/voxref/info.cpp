#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "commands.h"
#include "inputs.h"
#include "json.h"
#include "parallel.h"
#include "summary.h"

namespace voxref {

namespace {

constexpr std::array<int, 4> resolutions = {64, 128, 256, 512};

struct Options {
  CommonOptions common;
  SceneOptions scene;
};

/// What the pipeline would hold at one resolution.
struct VolumeNeed {
  int resolution = 0;
  Grid grid;
  size_t voxels = 0;    ///< occupied
  size_t surfaces = 0;  ///< bytes of albedo, normal, centroid, emission
  size_t radiance = 0;  ///< bytes of the voxels' radiance, direct and after the bounces
  size_t base = 0;      ///< bytes of radiance and opacity, filtered
  size_t levels = 0;    ///< bytes of all directional levels
  size_t total() const { return surfaces + radiance + base + levels; }
};

/// Bytes of a volume with those of its bricks that hold one of `texels` (moved: it is sorted and thinned out here).
template <class Texel>
size_t volume_bytes(const glm::ivec3& size, std::vector<glm::ivec3> texels) {
  using Volume = BrickVolume<Texel>;
  for (glm::ivec3& t : texels) t /= Volume::side;
  const auto before = [](const glm::ivec3& a, const glm::ivec3& b) {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  };
  std::sort(texels.begin(), texels.end(), before);
  const size_t bricks = static_cast<size_t>(std::unique(texels.begin(), texels.end()) - texels.begin());
  const glm::ivec3 table = (size + Volume::side - 1) / Volume::side;
  return bricks * Volume::texels_per_brick * sizeof(Texel) +
         size_t(table.x) * size_t(table.y) * size_t(table.z) * sizeof(uint32_t);
}

/// The scene's shape alone: where surface is does not depend on textures but for the holes of masks, and filtering them
/// takes nearly all the time.
Scene without_textures(const Scene& scene) {
  Scene plain;
  plain.positions = scene.positions;
  plain.normals = scene.normals;
  plain.triangles = scene.triangles;
  plain.triangle_materials = scene.triangle_materials;
  plain.objects = scene.objects;
  for (const Material& material : scene.materials) {
    plain.materials.emplace_back();
    plain.materials.back().emission = material.emission;  // whether there is any decides about a volume
  }
  return plain;
}

VolumeNeed measure(const Scene& scene, int resolution, const Progress& progress) {
  GridOptions options;
  options.resolution = resolution;
  const Grid grid = fit_grid(scene.bounds(), options);
  const SurfaceGrid surfaces = voxelize(scene, grid, {}, progress);
  VolumeNeed need;
  need.resolution = resolution;
  need.grid = grid;
  need.voxels = surfaces.size();
  need.surfaces = surfaces.bytes();
  need.radiance = 2 * surfaces.size() * sizeof(glm::vec3);
  need.base = volume_bytes<glm::vec4>(grid.size, surfaces.voxels);
  std::vector<glm::ivec3> texels = surfaces.voxels;
  for (glm::ivec3 size = grid.size; size != glm::ivec3(1);) {
    size = (size + 1) / 2;
    for (glm::ivec3& t : texels) t /= 2;
    need.levels += volume_bytes<DirectionalTexel>(size, texels);
  }
  return need;
}

nlohmann::json describe(const VolumeNeed& need) {
  return {{"resolution", need.resolution},
          {"grid", {need.grid.size.x, need.grid.size.y, need.grid.size.z}},
          {"voxel", need.grid.voxel},
          {"voxels_occupied", need.voxels},
          {"bytes",
           {{"surfaces", need.surfaces},
            {"radiance", need.radiance},
            {"base", need.base},
            {"levels", need.levels},
            {"total", need.total()}}}};
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
    line(n.resolution == resolutions.front() ? "volumes" : "",
         fmt::format("{:>4}: {}x{}x{}, {} voxels occupied; surfaces {}, radiance {}, base {}, levels {}, total {}",
                     n.resolution, n.grid.size.x, n.grid.size.y, n.grid.size.z, n.voxels, byte_count(n.surfaces),
                     byte_count(n.radiance), byte_count(n.base), byte_count(n.levels), byte_count(n.total())));
}

int run_info(const Options& options) {
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const Scene scene = load_scene(options.scene, terminal);
  std::vector<VolumeNeed> needs;
  needs.reserve(resolutions.size());
  const Scene shape = without_textures(scene);
  for (const int resolution : resolutions) needs.push_back(measure(shape, resolution, terminal.progress()));
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
  add_common_options(*command, options->common);
  command->footer(
      "The volumes are counted by voxelizing the scene at each resolution.\n\n"
      "Example:\n  voxref info scenes/cornell_box.glb");
  on_run(command, run, [options] { return run_info(*options); });
}

}  // namespace voxref
