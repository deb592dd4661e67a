#include <fmt/format.h>

#include "commands.h"
#include "cone/render.h"
#include "image/image_file.h"
#include "inputs.h"
#include "json.h"
#include "outputs.h"
#include "parallel.h"
#include "provenance.h"
#include "summary.h"
#include "voxel/volume_file.h"
#include "voxel/volume_writer.h"

namespace voxref {

namespace {

struct Options : RenderCommandOptions {
  SettingsOptions settings;
  std::string stage, from;
};

/// What gather writes.
std::filesystem::path image_file(const Options& options) {
  return std::filesystem::path(options.output) / "gather.exr";
}

/// What every stage starts from.
struct Input {
  const Options& options;
  Settings settings;
  VolumeFolder volumes;
  Terminal& terminal;
  std::filesystem::path output;
};

Scene stage_scene(const Input& input) {
  if (input.options.scene.file.empty()) throw Error("SCENE", "stage " + input.options.stage + " needs one");
  return load_scene(input.options.scene, input.terminal);
}

template <class Texel>
void run_shade(const Input& input) {
  const Scene scene = stage_scene(input);
  const Caster caster(scene);
  const SurfaceGrid surfaces = input.volumes.surfaces();
  const Settings& settings = input.settings;
  Shading lit = shade(scene, &caster, surfaces, settings.light, settings.shade, input.terminal.progress());
  Clamping clamped;
  for (glm::vec3& radiance : lit.radiance) radiance = clamped.store<Texel>(radiance);
  warn(input.terminal, clamped, settings.storage, "shading");
  VolumeFolderWriter writer(input.output, surfaces.grid, settings.storage);
  writer.write_visibility(surfaces, lit.visibility);
  writer.write_radiance(surfaces, lit.radiance, false);
  writer.finish();
}

template <class Texel>
void run_mipmap(const Input& input) {
  const Grid& grid = input.volumes.grid();
  VolumeFolderWriter writer(input.output, grid, input.settings.storage);
  bool found = false;
  for (const bool bounced : {false, true}) {
    if (!input.volumes.has(bounced ? "radiance_bounce" : "radiance")) continue;
    found = true;
    writer.write_levels(
        mipmap(grid, input.volumes.base<Texel>(bounced), input.settings.mipmap, input.terminal.progress()), bounced);
  }
  if (!found) throw Error(input.options.from, "volumes.json", "has neither radiance nor radiance_bounce to filter");
  writer.finish();
}

template <class Texel>
void run_bounce(const Input& input) {
  const SurfaceGrid surfaces = input.volumes.surfaces();
  const auto direct = input.volumes.radiance(surfaces, false);
  const Settings& settings = input.settings;
  // What the stage before made of it, where it is there: an error in it shall not be taken for one of this stage.
  const bool filtered = input.volumes.has(aniso_name(0, 0, false));
  BasicPyramid<Texel> pyramid =
      filtered ? input.volumes.pyramid<Texel>(false) : mipmap<Texel>(surfaces, direct, settings.mipmap);
  const BasicBounceResult<Texel> result =
      bounce(surfaces, direct, std::move(pyramid), settings.bounce, settings.render.cone, settings.mipmap,
             input.options.view.background, input.terminal.progress());
  warn(input.terminal, result.clamped, settings.storage, "the last bounce");
  VolumeFolderWriter writer(input.output, surfaces.grid, settings.storage);
  writer.write_radiance(surfaces, result.radiance, true);
  writer.write_levels(result.pyramid, true);
  writer.finish();
}

template <class Texel>
void run_gather(const Input& input) {
  const Scene scene = stage_scene(input);
  const View view = make_view(input.options.view, scene, cone_bytes_per_pixel);
  const Caster caster(scene);
  const bool bounced = input.volumes.has("radiance_bounce");
  const Settings& settings = input.settings;
  const LitVolume volume =
      lit_volume(input.volumes.pyramid<Texel>(bounced), settings.render.cone.opacity, settings.mipmap.filter);
  std::optional<LightVisibility> visibility;
  if (settings.render.pixel.shadow == PixelShadow::visibility) {
    const SurfaceGrid surfaces = input.volumes.surfaces();
    visibility.emplace(surfaces, input.volumes.visibility(surfaces));
  }
  const LitScene lit{scene,          caster,
                     volume,         settings.grid.bounds.value_or(scene.bounds()),
                     settings.light, visibility ? &*visibility : nullptr};
  ConeImage result = render_cones(lit, view, settings.render, input.terminal.progress());
  nlohmann::json origin = provenance(scene, view);
  origin["settings"] = to_json(settings);
  origin["volumes"] = input.options.from;
  attach(result.image, origin);
  std::filesystem::create_directories(input.output);
  write_exr(image_file(input.options), result.image);
}

int run_stage(const Options& options) {
  // One stage's volumes.json would replace that of all the others.
  if (same_place(options.from, options.output)) throw Error("-o", "'" + options.output + "' is the folder of --from");
  require_no_clash({options.scene.file, options.settings.config, {image_file(options)}, std::nullopt});
  require_folder(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const Input input{options, make_settings(options.settings), VolumeFolder(options.from), terminal, options.output};
  with_texel(input.settings.storage, [&]<class Texel>(std::type_identity<Texel>) {
    if (options.stage == "shade") run_shade<Texel>(input);
    if (options.stage == "mipmap") run_mipmap<Texel>(input);
    if (options.stage == "bounce") run_bounce<Texel>(input);
    if (options.stage == "gather") run_gather<Texel>(input);
  });
  terminal.say("written   " + options.output);
  terminal.result({{"stage", options.stage}, {"from", options.from}, {"output", options.output}});
  return exit_done;
}

}  // namespace

void add_stage(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("stage", "runs one stage on volumes that somebody else made");
  const auto options = std::make_shared<Options>();
  command
      ->add_option_function<std::string>(
          "STAGE",
          [options](const std::string& name) {
            if (name != "shade" && name != "mipmap" && name != "bounce" && name != "gather")
              throw Error("STAGE", "'" + name + "' is not shade, mipmap, bounce or gather");
            options->stage = name;
          },
          "shade (albedo, normal, emission -> radiance, visibility), mipmap (radiance, radiance_bounce -> aniso_*, "
          "aniso_bounce_*), bounce (radiance, and aniso_* if there -> radiance_bounce, aniso_bounce_*) or gather "
          "(aniso_bounce_*, or "
          "aniso_* where there is no bounce -> gather.exr)")
      ->required()
      ->type_name("");
  add_render_options(*command, *options, "DIR", "folder for what the stage makes", [&] {
    command->add_option("--from", options->from, "folder of volumes to read")->required()->type_name("DIR");
    add_settings_options(*command, options->settings);
  });
  command->get_option("SCENE")->required(false);
  command->footer(
      "shade and gather need SCENE.\n\nExample:\n"
      "  voxref cone scenes/cornell_box_point.glb -o cone.exr --volumes volumes\n"
      "  voxref stage mipmap --from volumes -o filtered");
  on_run(command, run, [options] { return run_stage(*options); });
}

}  // namespace voxref
