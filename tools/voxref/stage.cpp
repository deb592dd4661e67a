#include <fmt/format.h>

#include "commands.h"
#include "cone/render.h"
#include "image/image_file.h"
#include "inputs.h"
#include "json.h"
#include "outputs.h"
#include "parallel.h"
#include "provenance.h"
#include "stages.h"
#include "summary.h"

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

const SceneOptions& needed_scene(const Options& options) {
  if (options.scene.file.empty()) throw Error("SCENE", "stage " + options.stage + " needs one");
  return options.scene;
}

template <class Texel>
void run_gather(const Input& input) {
  const OpenedScene opened(needed_scene(input.options), input.options.view, cone_bytes_per_pixel, input.terminal);
  const auto& [scene, view, caster] = opened;
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
  warn_nonfinite(input.terminal, result);
}

int run_stage(const Options& options) {
  // One stage's volumes.json would replace that of all the others.
  if (same_place(options.from, options.output)) throw Error("-o", "'" + options.output + "' is the folder of --from");
  require_no_clash({options.scene.file, options.settings.config, {image_file(options)}, std::nullopt});
  require_folder(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const Input input{options, make_settings(options.settings), VolumeFolder(options.from), terminal, options.output};
  const Progress progress = terminal.progress();
  const Settings& settings = input.settings;
  if (options.stage == "shade")
    warn(terminal,
         run_shade(input.volumes, load_scene(needed_scene(options), terminal), settings, input.output, progress),
         settings.storage, "shading");
  if (options.stage == "mipmap") run_mipmap(input.volumes, settings, input.output, progress);
  if (options.stage == "bounce")
    warn(terminal, run_bounce(input.volumes, settings, options.view.background, input.output, progress),
         settings.storage, "the last bounce");
  if (options.stage == "gather")
    with_texel(settings.storage, [&]<class Texel>(std::type_identity<Texel>) { run_gather<Texel>(input); });
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
