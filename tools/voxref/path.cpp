#include "reference/path.h"

#include <fmt/format.h>

#include "commands.h"
#include "file.h"
#include "image/image_file.h"
#include "json.h"
#include "parallel.h"
#include "provenance.h"
#include "summary.h"

namespace voxref {

namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene;
  ViewOptions view;
  PathOptions path;
  std::string output;
};

int run_path(const Options& options) {
  require_writable(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const Scene scene = load_scene(options.scene, terminal);
  const View view = make_view(options.view, scene);
  const Caster caster(scene);
  PathResult result = path_trace(scene, caster, view, options.path, terminal.progress());

  nlohmann::json origin = provenance(scene, view);
  origin["seed"] = options.path.seed;
  origin["spp"] = result.spp;
  if (options.path.max_depth) origin["max_depth"] = *options.path.max_depth;
  attach(result.image, origin);
  write_exr(options.output, result.image);

  say(terminal, result);
  terminal.say("written   " + options.output);
  terminal.result(to_json(result));
  if (!result.interrupted) return exit_done;
  fmt::print(stderr, "voxref: interrupted: {} holds {} samples per pixel\n", options.output, result.spp);
  return exit_outside_limits;
}

}  // namespace

void add_path(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("path", "path traces a scene: the ground truth, with its standard error");
  const auto options = std::make_shared<Options>();
  add_scene_options(*command, options->scene);
  add_output_option(*command, options->output, "FILE", "OpenEXR file to write");
  add_path_options(*command, options->path);
  add_view_options(*command, options->view);
  add_common_options(*command, options->common);
  command->footer("Example:\n  voxref path scenes/cornell_box.glb -o cornell.exr --noise 0.01 --size 256x256");
  on_run(command, run, [options] { return run_path(*options); });
}

}  // namespace voxref
