#include "study/study.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "commands.h"
#include "error.h"
#include "inputs.h"
#include "parallel.h"
#include "provenance.h"
#include "study/study_report.h"
#include "terminal.h"

namespace voxref {

namespace {

struct Options {
  CommonOptions common;
  std::string name, output, gpu_image;
  std::vector<std::string> scenes;
  bool list = false, quick = false;
};

/// What the times were measured on.
std::string machine() {
  utsname system{};
  uname(&system);
  return fmt::format("{} {}, {} threads of {} cores", system.sysname, system.machine, thread_count(),
                     std::thread::hardware_concurrency());
}

/// Where assets/ lies: VOXREF_ASSETS, else ../shared beside the current folder; empty: nowhere.
std::filesystem::path find_assets() {
  const char* given = std::getenv("VOXREF_ASSETS");
  for (const std::filesystem::path& folder :
       {std::filesystem::path(given ? given : ""), std::filesystem::path("../shared")})
    if (!folder.empty() && std::filesystem::is_directory(folder / "assets")) return folder;
  return {};
}

StudyScene load(const std::string& file, Terminal& terminal) {
  SceneOptions options;
  options.file = file;
  StudyScene result{std::filesystem::path(file).stem().string(), load_scene(options, terminal), {}};
  result.view.camera = result.scene.cameras.empty() ? framing_camera(result.scene) : result.scene.cameras.front();
  return result;
}

std::vector<Study> chosen(const std::string& name) {
  std::vector<Study> found;
  std::string names;
  for (const Study& study : studies()) {
    if (name == study.name || name == "all") found.push_back(study);
    names += study.name + ", ";
  }
  if (name.empty()) throw Error("NAME", "needed, but not given; there are: " + names + "all");
  if (found.empty()) throw Error("'" + name + "'", "is no study; there are: " + names + "all");
  return found;
}

int list_studies(const Options& options) {
  Terminal terminal(options.common);
  nlohmann::json list = nlohmann::json::array();
  for (const Study& study : studies()) {
    terminal.say(fmt::format("{:<10} {}", study.name, study.sentence));
    list.push_back({{"name", study.name}, {"sentence", study.sentence}});
  }
  terminal.result({{"studies", list}});
  return exit_done;
}

int run_study(const Options& options) {
  if (options.list) return list_studies(options);
  const std::vector<Study> wanted = chosen(options.name);
  if (options.output.empty()) throw Error("-o", "needed, but not given");
  require_folder(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  StudyRequest request;
  request.quick = options.quick;
  request.assets = find_assets();
  request.gpu_image = options.gpu_image;
  request.progress = terminal.progress();
  for (const std::string& file : options.scenes) request.scenes.push_back(load(file, terminal));

  std::vector<StudyResult> results;
  for (const Study& study : wanted) {
    results.push_back(study.run(request));
    for (const std::string& skipped : results.back().skipped) terminal.warn("voxref: skipped: " + skipped);
    for (const Section& section : results.back().sections)
      terminal.say(fmt::format("{:<10} {}: {:.1f} s", study.name, section.title, section.seconds));
  }
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) terminal.warn("voxref: warning: gnuplot is not installed (Debian: gnuplot-nox): data without charts");
  nlohmann::json origin = program_provenance();
  origin["machine"] = machine();
  write_studies(options.output, results, origin, gnuplot);
  terminal.say("report     " + (std::filesystem::path(options.output) / "report.html").string());
  terminal.result(study_result(results, origin));
  return exit_done;
}

}  // namespace

void add_study(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("study", "what the approximations cost and gain: data, charts, a page");
  const auto options = std::make_shared<Options>();
  command->add_option("NAME", options->name, "a study, or all")->type_name("");
  command->add_option("SCENE", options->scenes, "glTF files in place of the study's own scenes")->type_name("");
  command->add_flag("--list", options->list, "says which studies there are");
  add_output_option(*command, options->output, "DIR", "folder for tables, charts, result.json and report.html");
  command->get_option("-o")->required(false);  // --list writes nothing
  command->add_flag("--quick", options->quick, "small sizes: minutes instead of an hour");
  command->add_option("--gpu", options->gpu_image, "your own rendering of SCENE, R,G,B before tone mapping, for ladder")
      ->type_name("FILE");
  add_common_options(*command, options->common);
  command->footer(
      "The larger public scenes are looked for in VOXREF_ASSETS/assets, then in ../shared/assets. Charts need "
      "gnuplot.\n"
      "Ctrl-C writes nothing and exits with 2.\n\n"
      "Example:\n  voxref study pareto scenes/cornell_box_point.glb -o out/pareto --quick");
  on_run(command, run, [options] { return run_study(*options); });
}

}  // namespace voxref
