#include <fmt/format.h>

#include <cmath>

#include "commands.h"
#include "compare/report.h"
#include "json.h"
#include "parallel.h"
#include "parse.h"
#include "pipeline.h"
#include "provenance.h"
#include "summary.h"

namespace voxref {

namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene;
  ViewOptions view;
  PathOptions path;
  SettingsOptions settings;
  std::optional<double> budget;
  std::string output;
  ConeTraceOutputs outputs;
};

void say_verdict(Terminal& terminal, const CheckReport& report) {
  const Metrics& m = report.metrics;
  terminal.say(fmt::format("{:<9} cone / path = {:.4f}, relative error {:.2f} %, noise share {:.2f} %  ({})", "verdict",
                           m.mean_ratio, 100 * m.rel_error, 100 * m.noise_share,
                           m.indirect_only ? "indirect light" : "all light"));
  terminal.say(fmt::format("{:<9} RMSE {:.4g}, relMSE {:.4g}, PSNR {:.2f} dB, SSIM {:.4f}, FLIP {:.4f}", "pictures",
                           m.rmse, m.relmse, m.psnr, m.ssim, m.flip));
  if (const std::optional<bool> within = within_budget(report))
    terminal.say(fmt::format("{:<9} {} {:.2f} %", "budget", *within ? "within" : "EXCEEDS", 100 * *report.budget));
}

int run_check(const Options& options) {
  const Settings settings = make_settings(options.settings);
  require_folder(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const Scene scene = load_scene(options.scene, terminal);
  const View view = make_view(options.view, scene);
  const Caster caster(scene);
  // The cone tracer first: it is quick, and refuses what it cannot do before the path tracer has worked for minutes.
  ConeTraceResult cone = cone_trace(scene, caster, view, settings, options.outputs, terminal.progress());
  PathResult path = path_trace(scene, caster, view, options.path, terminal.progress());
  if (path.interrupted) throw Interrupted();  // a comparison with fewer samples than asked for is not the one asked for

  nlohmann::json origin = provenance(scene, view);
  origin["seed"] = options.path.seed;
  origin["spp"] = path.spp;
  origin["settings"] = to_json(settings);
  attach(path.image, origin);
  attach(cone.image.image, origin);

  const bool punctual = !scene.has_emission() && view.background == glm::vec3(0.0f);
  const float exposure = auto_exposure(path.image);
  const CheckReport report = {.title = std::filesystem::path(scene.file).filename().string(),
                              .cone = cone.image.image,
                              .path = path.image,
                              .metrics = compare(cone.image.image, path.image, punctual, exposure),
                              .exposure = exposure,
                              .budget = options.budget,
                              .cone_result = to_json(cone),
                              .path_result = to_json(path),
                              .provenance = origin};
  write_check(options.output, report);

  say(terminal, path);
  say(terminal, cone);
  say_verdict(terminal, report);
  terminal.say("report    " + (std::filesystem::path(options.output) / "report.html").string());
  terminal.result(check_result(report));
  return within_budget(report).value_or(true) ? exit_done : exit_outside_limits;
}

}  // namespace

void add_check(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("check", "both renderers from one camera, compared, with a report page");
  const auto options = std::make_shared<Options>();
  add_scene_options(*command, options->scene);
  add_output_option(*command, options->output, "DIR", "folder for images, pictures, result.json and report.html");
  add_value_option(*command, "--budget", "R", "exit with 1 when the relative error exceeds R (0.2 = 20 %)",
                   [options](const std::string& text) { options->budget = parse_number("--budget", text, 0, 1e6); });
  add_settings_options(*command, options->settings);
  add_volumes_option(*command, options->outputs);
  add_path_options(*command, options->path);
  add_view_options(*command, options->view);
  add_common_options(*command, options->common);
  command->footer("Example:\n  voxref check scenes/cornell_box_point.glb -o out/cornell --spp 256 --budget 0.2");
  on_run(command, run, [options] { return run_check(*options); });
}

}  // namespace voxref
