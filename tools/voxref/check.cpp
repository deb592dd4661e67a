#include <fmt/format.h>

#include <cmath>

#include "commands.h"
#include "compare/measured.h"
#include "compare/report.h"
#include "inputs.h"
#include "json.h"
#include "outputs.h"
#include "parallel.h"
#include "parse.h"
#include "pipeline.h"
#include "provenance.h"
#include "summary.h"

namespace voxref {

namespace {

struct Options : ConeCommandOptions {
  PathOptions path;
  std::optional<double> budget;
};

std::vector<std::filesystem::path> written_files(const Options& options) {
  std::vector<std::filesystem::path> files;
  for (const std::string_view name : check_files) files.push_back(std::filesystem::path(options.output) / name);
  return files;
}

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

/// Gives the cone tracer the bounces of paths that end at `max_depth`, unless their number was asked for. What its
/// image gathers has been scattered once at the voxels where it comes from punctual lights; where surfaces or the
/// background glow it comes from there straight. Each bounce adds one scattering to either.
/// @param lights whether there are punctual ones @param glow whether there is light of surfaces or the background
void match_depth(Settings& settings, int max_depth, bool lights, bool glow, Terminal& terminal) {
  if (settings.bounce.count) return;
  if (lights && glow) {
    terminal.warn(
        "voxref: warning: --max-depth: no bounce.count lets the cone tracer stop there too where punctual lights and "
        "glowing surfaces or a background both light the scene; it stays auto");
    return;
  }
  constexpr int most_bounces = 1000;  // of bounce.count
  const int least = glow ? 1 : 2;
  if (max_depth < least)
    throw Error("--max-depth",
                fmt::format("{} is below {}: cones gather light that {}, and nothing before that", max_depth, least,
                            glow ? "comes from another surface" : "a surface has scattered already"));
  // Longer paths than the most bounces differ from endless ones by nothing, and so auto serves them.
  if (max_depth - least <= most_bounces) settings.bounce.count = max_depth - least;
}

int run_check(const Options& options) {
  Settings settings = make_settings(options.settings);
  require_no_clash({options.scene.file, options.settings.config, written_files(options), options.outputs.volumes});
  require_folder(options.output);
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  // The cone tracer's image is there while the path tracer works; comparing the two needs less than that.
  const OpenedScene opened(options.scene, options.view, cone_image_bytes_per_pixel + path_bytes_per_pixel(options.path),
                           terminal);
  const auto& [scene, view, caster] = opened;
  const bool indirect = compares_indirect(scene, view);
  if (options.path.max_depth)
    match_depth(settings, *options.path.max_depth, !scene.lights.empty(), !indirect, terminal);
  // The cone tracer first: it is quick, and refuses what it cannot do before the path tracer has worked for minutes.
  ConeTraceResult cone = cone_trace(scene, caster, view, settings, options.outputs, terminal.progress());
  PathResult path = path_trace(scene, caster, view, options.path, terminal.progress());
  if (path.interrupted) throw Interrupted();  // a comparison with fewer samples than asked for is not the one asked for

  nlohmann::json origin = provenance(scene, view);
  add_path_provenance(origin, options.path, path.spp);
  origin["settings"] = to_json(settings);
  attach(path.image, origin);
  attach(cone.image.image, origin);

  const float exposure = auto_exposure(path.image);
  const CheckReport report = {.title = std::filesystem::path(scene.file).filename().string(),
                              .cone = cone.image.image,
                              .path = path.image,
                              .metrics = compare(cone.image.image, path.image, indirect, exposure),
                              .exposure = exposure,
                              .budget = options.budget,
                              .cone_result = to_json(cone),
                              .path_result = to_json(path),
                              .provenance = origin};
  write_check(options.output, report);

  say(terminal, path);
  say(terminal, cone, settings.storage);
  say_verdict(terminal, report);
  terminal.say("report    " + (std::filesystem::path(options.output) / "report.html").string());
  terminal.result(check_result(report));
  return within_budget(report).value_or(true) ? exit_done : exit_outside_limits;
}

}  // namespace

void add_check(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("check", "both renderers from one camera, compared, with a report page");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, *options, "DIR", "folder for images, pictures, result.json and report.html", [&] {
    add_value_option(*command, "--budget", "R", "exit with 1 when the relative error exceeds R (0.2 = 20 %)",
                     [options](const std::string& text) { options->budget = parse_number("--budget", text, 0, 1e6); });
    add_settings_options(*command, options->settings);
    add_volumes_option(*command, options->outputs);
    add_path_options(*command, options->path);
  });
  command->footer(
      "Ctrl-C writes neither images nor report, and exits with 2; volumes that are finished stay.\n\n"
      "Example:\n  voxref check scenes/cornell_box_point.glb -o out/cornell --spp 256 --budget 0.2");
  on_run(command, run, [options] { return run_check(*options); });
}

}  // namespace voxref
