#include <fmt/format.h>

#include "commands.h"
#include "file.h"
#include "image/image_file.h"
#include "inputs.h"
#include "json.h"
#include "outputs.h"
#include "parallel.h"
#include "pipeline.h"
#include "provenance.h"
#include "summary.h"

namespace voxref {

namespace {

int run_cone(const ConeCommandOptions& options) {
  const Settings settings = make_settings(options.settings);
  require_no_clash({options.scene.file, options.settings.config, {options.output}, options.outputs.volumes});
  require_writable(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const OpenedScene opened(options.scene, options.view, cone_bytes_per_pixel, terminal);
  const auto& [scene, view, caster] = opened;
  ConeTraceResult result = cone_trace(scene, caster, view, settings, options.outputs, terminal.progress());

  nlohmann::json origin = provenance(scene, view);
  origin["settings"] = to_json(settings);
  attach(result.image.image, origin);
  write_exr(options.output, result.image.image);

  say(terminal, result, settings.storage);
  terminal.say("written   " + options.output);
  if (options.outputs.volumes) terminal.say("volumes   " + options.outputs.volumes->string());
  terminal.result(to_json(result));
  return exit_done;
}

std::string parameter_table() {
  std::string table =
      "Parameters (--set KEY=VALUE, or nested JSON in a --config file): value in the profiles radiometric and "
      "villegas2016, range, meaning\n";
  for (const ParameterHelp& line : parameter_help())
    table += fmt::format("  {:<29} {:<16} {:<16} {:<30} {}\n", line.key, line.radiometric, line.villegas2016,
                         line.range, line.meaning);
  return table;
}

}  // namespace

void add_cone(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("cone", "voxelizes, shades, filters and cone traces a scene");
  const auto options = std::make_shared<ConeCommandOptions>();
  add_render_options(*command, *options, "FILE", "OpenEXR file to write", [&] {
    add_settings_options(*command, options->settings);
    add_volumes_option(*command, options->outputs);
  });
  command->footer(parameter_table() +
                  "\nCtrl-C writes nothing, no volumes either, and exits with 2.\n\nExample:\n  voxref cone "
                  "scenes/cornell_box_point.glb -o cone.exr --set grid.resolution=128");
  on_run(command, run, [options] { return run_cone(*options); });
}

}  // namespace voxref
