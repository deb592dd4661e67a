#include "study/study.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "commands.h"
#include "error.h"
#include "inputs.h"
#include "parallel.h"
#include "provenance.h"
#include "study/gnuplot.h"
#include "study/ladder.h"
#include "study/study_report.h"
#include "study/users_image.h"
#include "terminal.h"

namespace voxref {

namespace {

/// Flags as they were given, each with its value, to repeat them.
using Words = std::vector<std::pair<std::string, std::string>>;

struct Options {
  CommonOptions common;
  std::string name, output;
  std::vector<std::string> scenes;
  SceneOptions loading;  ///< of each SCENE, whose file it leaves open
  ViewOptions view;
  SettingsOptions settings{{}, {}, {}};  ///< without a profile where none was given
  std::string users_image;
  Words of_scenes, of_goal;  ///< what was given of loading and view; of settings and users_image
  bool list = false, quick = false;
};

/// What the times were measured on.
std::string machine() {
  utsname system{};
  uname(&system);
  return fmt::format("{}, {} threads of {} cores, {} {}", cpu_model(), thread_count(),
                     std::thread::hardware_concurrency(), system.sysname, system.machine);
}

/// Where assets/ lies: VOXREF_ASSETS, else ../shared beside the current folder; empty: nowhere.
std::filesystem::path find_assets() {
  const char* given = std::getenv("VOXREF_ASSETS");
  for (const std::filesystem::path& folder :
       {std::filesystem::path(given ? given : ""), std::filesystem::path("../shared")})
    if (!folder.empty() && std::filesystem::is_directory(folder / "assets")) return folder;
  return {};
}

/// What files of a scene's study are called after.
std::string scene_name(const std::string& file) { return std::filesystem::path(file).stem().string(); }

StudyScene load(const std::string& file, const Options& options, Terminal& terminal) {
  SceneOptions loading = options.loading;
  loading.file = file;
  StudyScene result{scene_name(file), load_scene(loading, terminal), {}};
  result.view = make_view(options.view, result.scene, 0);
  return result;
}

/// Somebody else's rendering, which must be one that the scene's camera can take.
Image load_users_image(const Options& options, const StudyScene& scene) {
  const std::string& file = options.users_image;
  if (scene.scene.cameras.empty() && !options.view.eye)
    throw Error(file, "camera", "the scene has none: --eye and --target say where the image was taken from");
  Image image = read_users_image(file);
  View view = scene.view;
  view.width = image.width();
  view.height = image.height();
  const float aspect = view.camera.aspect;
  const auto width = static_cast<float>(view.width), height = static_cast<float>(view.height);
  // A camera of one's own has no aspect; sides are rounded to pixels.
  if (!options.view.eye && std::abs(width - aspect * height) > std::max(1.0f, aspect))
    throw Error(file, "size",
                fmt::format("{}x{} is {:.4g} times as wide as high, the scene's camera '{}' {:.4g}; --camera, or --eye "
                            "and --target, name another",
                            view.width, view.height, width / height, view.camera.name, aspect));
  require_memory(file + ": size", view, ladder_bytes_per_pixel(ladder_options(options.quick)));
  return image;
}

/// The settings that were given, if any were.
std::optional<Settings> load_settings(SettingsOptions options) {
  if (options.profile.empty() && options.config.empty() && options.assignments.empty()) return std::nullopt;
  if (options.profile.empty()) options.profile = SettingsOptions().profile;
  return make_settings(options);
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

/// What was asked for must be the studies' to use, and files of theirs must not meet.
void check(const Options& options, std::span<const Study> wanted) {
  for (const Study& study : wanted)
    if (!options.scenes.empty() && !study.takes_scenes)
      throw Error("SCENE", "is not for " + study.name + ", which has scenes of its own");
  const bool settings_serve =
      std::any_of(wanted.begin(), wanted.end(), [](const Study& study) { return study.takes_settings; });
  if (!options.of_goal.empty() && !settings_serve) throw Error(options.of_goal.front().first, "is for ladder alone");
  if (!options.of_scenes.empty() && options.scenes.empty())
    throw Error(options.of_scenes.front().first, "needs the SCENE that it is for");
  if (!options.users_image.empty() && options.scenes.size() != 1)
    throw Error("--gpu", "needs the one scene that the image shows");
  std::set<std::string> names;
  for (const std::string& scene : options.scenes)
    if (!names.insert(scene_name(scene)).second)
      throw Error(scene, "another SCENE has this name, and files are called after it");
}

/// The line that repeats one study of those that were asked for.
std::string command(const Options& options, const Study& study) {
  std::string line = "voxref study " + study.name;
  for (const std::string& scene : options.scenes) line += " " + shell_word(scene);
  line += " -o " + shell_word(options.output);
  if (options.quick) line += " --quick";
  if (options.common.threads > 0) line += fmt::format(" --threads {}", options.common.threads);
  const auto add = [&line](const Words& words) {
    for (const auto& [flag, value] : words) line += " " + flag + " " + shell_word(value);
  };
  add(options.of_scenes);
  if (study.takes_settings) add(options.of_goal);
  return line;
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
  check(options, wanted);
  require_folder(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  StudyRequest request;
  request.quick = options.quick;
  request.assets = find_assets();
  request.settings = load_settings(options.settings);
  for (const std::string& file : options.scenes) request.scenes.push_back(load(file, options, terminal));
  if (!options.users_image.empty()) request.users_image = load_users_image(options, request.scenes.front());

  const auto gnuplot = find_gnuplot();
  if (gnuplot)
    require_drawing(*gnuplot);
  else
    terminal.warn("voxref: warning: gnuplot is not installed (Debian: gnuplot-nox): data without charts");
  nlohmann::json origin = program_provenance();
  origin["machine"] = machine();
  if (!request.assets.empty()) origin["assets"] = request.assets.string();
  std::vector<StudyResult> results;
  for (const Study& study : wanted) {
    request.progress = inside(terminal.progress(), study.name);
    StudyResult& result = results.emplace_back(study.run(request));
    result.command = command(options, study);
    for (const std::string& skipped : result.skipped) terminal.warn("voxref: skipped: " + skipped);
    for (const Section& section : result.sections) {
      for (const std::string& warning : section.warnings)
        terminal.warn("voxref: warning: " + section.title + ": " + warning);
      terminal.say(fmt::format("{:<10} {}: {:.1f} s", study.name, section.title, section.seconds));
    }
    // After each: what stops the next takes nothing of this one away.
    write_tables(options.output, result, origin);
    write_result(options.output, results, origin);
    if (gnuplot) draw_charts(options.output, result, *gnuplot);
    write_page(options.output, results, origin, gnuplot.has_value());
  }
  terminal.say("report     " + (std::filesystem::path(options.output) / "report.html").string());
  terminal.result(study_result(results, origin));
  return exit_done;
}

/// What was given of some flags.
Words given(const CLI::App& command, std::initializer_list<const char*> flags) {
  Words words;
  for (const char* flag : flags)
    for (const std::string& value : command.get_option(flag)->results()) words.emplace_back(flag, value);
  return words;
}

}  // namespace

void add_study(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("study", "what the approximations cost and gain: data, charts, a page");
  const auto options = std::make_shared<Options>();
  command->add_option("NAME", options->name, "a study, or all")->type_name("");
  command->add_option("SCENE", options->scenes, "glTF files in place of the own scenes of pareto and ladder")
      ->type_name("");
  command->add_flag("--list", options->list, "says which studies there are");
  add_output_option(*command, options->output, "DIR", "folder for tables, charts, result.json and report.html");
  command->get_option("-o")->required(false);  // --list writes nothing
  command->add_flag("--quick", options->quick, "small sizes: minutes instead of an hour");
  add_settings_options(*command, options->settings);
  command
      ->add_option("--gpu", options->users_image,
                   "your own rendering of SCENE, R,G,B before tone mapping, taken at the pixels' centres, for ladder")
      ->type_name("FILE");
  add_loading_options(*command, options->loading);
  add_camera_options(*command, options->view);
  add_common_options(*command, options->common);
  command->parse_complete_callback([options, command] {
    options->of_scenes = given(*command, {"--light-scale", "--at", "--dynamic", "--sun", "--camera", "--eye",
                                          "--target", "--up", "--yfov", "--background"});
    options->of_goal = given(*command, {"--profile", "--config", "--set", "--gpu"});
  });
  command->footer(
      "The larger public scenes are looked for in VOXREF_ASSETS/assets, then in ../shared/assets. Charts need "
      "gnuplot.\n"
      "Each study is written as it ends. Ctrl-C writes nothing of the running one and exits with 2.\n\n"
      "The ladder goes on from the shipped settings to those of --profile, --config and --set, parameter by parameter\n"
      "(default: villegas2016 at the ladder's resolution), and from there to the image of --gpu, at that image's "
      "size:\n"
      "give the settings, the camera and the surroundings that it was made with. It is read as diff reads images.\n\n"
      "Examples:\n  voxref study pareto scenes/cornell_box_point.glb -o out/pareto --quick\n"
      "  voxref study ladder scene.glb --config settings.json --gpu mine.exr -o out/ladder");
  on_run(command, run, [options] { return run_study(*options); });
}

}  // namespace voxref
