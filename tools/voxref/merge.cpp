#include "reference/merge.h"

#include <fmt/format.h>

#include <cmath>

#include "commands.h"
#include "error.h"
#include "file.h"
#include "image/image_file.h"
#include "json.h"
#include "outputs.h"
#include "provenance.h"
#include "terminal.h"

namespace voxref {

namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> parts;
  std::string output;
};

/// The image's mean and its standard error, as `path` says them: pixels are independent.
nlohmann::json result_of(const Image& image, size_t parts) {
  glm::vec3 mean(0.0f), error(0.0f);
  const auto value = image.layer(""), deviation = image.layer("stderr");
  for (int c = 0; c < 3; ++c) {
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      sum += value[c][i];
      squares += static_cast<double>(deviation[c][i]) * deviation[c][i];
    }
    mean[c] = static_cast<float>(sum / static_cast<double>(image.pixel_count()));
    error[c] = static_cast<float>(std::sqrt(squares) / static_cast<double>(image.pixel_count()));
  }
  return {{"parts", parts},
          {"mean", to_json(mean)},
          {"mean_stderr", to_json(error)},
          {"spp", static_cast<int>(image.channel("samples")[0])}};
}

int run_merge(const Options& options) {
  for (const std::string& part : options.parts)
    if (same_place(part, options.output)) throw Error("-o", "'" + options.output + "' is one of the parts");
  require_writable(options.output);
  Terminal terminal(options.common);
  const Progress progress = terminal.progress();
  PartMerger merger;
  for (size_t i = 0; i < options.parts.size(); ++i) {
    progress.check();
    merger.add(options.parts[i], read_image(options.parts[i]));
    progress("merging", static_cast<double>(i + 1) / static_cast<double>(options.parts.size()));
  }
  Image image = merger.finish();
  attach(image, program_provenance());
  write_exr(options.output, image);
  const nlohmann::json result = result_of(image, options.parts.size());
  terminal.say(fmt::format("merged    {} parts, {} samples per pixel", options.parts.size(), result["spp"].get<int>()));
  terminal.say("written   " + options.output);
  terminal.result(result);
  return exit_done;
}

}  // namespace

void add_merge(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("merge", "joins parts rendered elsewhere (path --part I/N) to one image");
  const auto options = std::make_shared<Options>();
  command->add_option("PART", options->parts, "images that path --part wrote, all N of them, in any order")
      ->required()
      ->type_name("FILE...");
  add_output_option(*command, options->output, "FILE", "OpenEXR file to write: the bits of a render in one piece");
  add_common_options(*command, options->common);
  command->footer(
      "Example:\n"
      "  seq 8 | parallel voxref path scene.glb -o part{}.exr --spp 1024 --part {}/8\n"
      "  voxref merge part*.exr -o whole.exr");
  on_run(command, run, [options] { return run_merge(*options); });
}

}  // namespace voxref
