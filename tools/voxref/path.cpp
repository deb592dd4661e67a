#include "reference/path.h"

#include <fmt/format.h>

#include <filesystem>

#include "commands.h"
#include "error.h"
#include "file.h"
#include "image/image_file.h"
#include "inputs.h"
#include "json.h"
#include "outputs.h"
#include "parallel.h"
#include "parse.h"
#include "provenance.h"
#include "reference/identity.h"
#include "reference/merge.h"
#include "summary.h"

namespace voxref {

namespace {

struct Options : RenderCommandOptions {
  PathOptions path;
};

/// What the pixels depend on, as values: a default that is typed out is the same render.
nlohmann::json dependencies(const Options& options, const Scene& scene, const View& view) {
  nlohmann::json json = provenance(scene, view);
  // Neither where the scene lies, nor how it was asked for.
  json.erase("scene");
  json.erase("command_line");
  json["load"] = describe(options.scene);
  json["path"] = describe(options.path);
  return json;
}

int run_path(Options& options, const CLI::App& command) {
  options.path.checkpoint.file = options.output + ".checkpoint";
  require_no_clash({options.scene.file, {}, {options.output, options.path.checkpoint.file}, {}});
  require_writable(options.output);
  remove_leftovers(options.output);
  remove_leftovers(options.path.checkpoint.file);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const OpenedScene opened(options.scene, options.view, path_bytes_per_pixel(options.path), terminal);
  const auto& [scene, view, caster] = opened;
  const bool is_part = command.count("--part") > 0;
  nlohmann::json depends = dependencies(options, scene, view);
  const std::string render = depends.dump();
  if (is_part) depends["part"] = fmt::format("{}/{}", options.path.part.index, options.path.part.count);
  options.path.checkpoint.render = depends.dump();
  PathResult result = path_trace(scene, caster, view, options.path, terminal.progress());

  nlohmann::json origin = provenance(scene, view);
  add_path_provenance(origin, options.path, result.spp);
  attach(result.image, origin);
  if (is_part) mark_part(result.image, options.path.part, options.path.spp, render);
  write_exr(options.output, result.image);
  if (!result.interrupted) std::filesystem::remove(options.path.checkpoint.file);

  say(terminal, result);
  terminal.say("written   " + options.output);
  terminal.result(to_json(result));
  if (!result.interrupted) return exit_done;
  fmt::print(stderr, "voxref: interrupted: {} holds {} samples per pixel; --resume goes on\n", options.output,
             result.spp);
  return exit_outside_limits;
}

void add_farm_options(CLI::App& command, PathOptions& options) {
  command.add_flag("--resume", options.checkpoint.resume,
                   "goes on from FILE.checkpoint, where an earlier run left one, to the same bits");
  add_value_option(command, "--checkpoint", "S", "seconds between checkpoints (default: 60)",
                   [&options](const std::string& text) {
                     options.checkpoint.interval = parse_number("--checkpoint", text, 0.01, 1e9);
                   });
  add_value_option(command, "--part", "I/N", "only the I-th of N parts (I from 1); voxref merge joins them",
                   [&options](const std::string& text) {
                     const std::optional<Part> part = parse_part(text);
                     if (!part) throw Error("--part", "'" + text + "' is not I/N with I from 1 to N");
                     options.part = *part;
                   });
}

}  // namespace

void add_path(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("path", "path traces a scene: the ground truth, with its standard error");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, *options, "FILE", "OpenEXR file to write", [&] {
    add_path_options(*command, options->path);
    add_farm_options(*command, options->path);
  });
  command->footer(
      "Ctrl-C writes the samples that there are, and exits with 1.\n\n"
      "Example:\n"
      "  voxref path scenes/cornell_box.glb -o cornell.exr --noise 0.01 --size 256x256\n"
      "A killed render goes on with --resume. Parts may be rendered anywhere: with GNU parallel, or, as "
      "tools/farm.sbatch\n"
      "does it, as a Slurm job array; merge joins them to the bits of a single render:\n"
      "  seq 8 | parallel --retries 3 voxref path scene.glb -o part{}.exr --part {}/8 --resume --spp 4096\n"
      "  voxref merge part*.exr -o whole.exr");
  on_run(command, run, [options, command] { return run_path(*options, *command); });
}

}  // namespace voxref
