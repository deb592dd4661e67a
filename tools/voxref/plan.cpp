#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "error.h"
#include "file.h"
#include "inputs.h"
#include "outputs.h"
#include "parallel.h"
#include "parse.h"
#include "study/planner.h"
#include "summary.h"
#include "terminal.h"

namespace voxref {

namespace {

struct Options {
  CommonOptions common;
  SceneOptions scene;
  ViewOptions view;
  SettingsOptions settings;
  PlanOptions plan;
  std::optional<double> budget;
  std::string output;
};

std::string sentence(const PlannedSetting& setting) {
  return fmt::format("error {:.1f} % +- {:.1f}, about {:.2g} s and {}: {}", 100 * setting.rel_error,
                     100 * setting.rel_error_stderr, setting.seconds, byte_count(setting.bytes),
                     assignments(setting.settings));
}

nlohmann::json describe(const std::optional<PlannedSetting>& setting) {
  if (!setting) return nullptr;
  return {{"settings", config(setting->settings)},
          {"rel_error", setting->rel_error},
          {"rel_error_stderr", setting->rel_error_stderr},
          {"seconds", setting->seconds},
          {"bytes", setting->bytes},
          {"assignments", assignments(setting->settings)}};
}

void say(Terminal& terminal, const Plan& plan, const Options& options) {
  for (const std::string& line : plan.dropped) terminal.say("unused    " + line);
  if (plan.best)
    terminal.say("plan      " + sentence(*plan.best));
  else
    terminal.say(fmt::format("plan      no setting reaches {:g} %", 100 * *options.budget));
  if (!plan.best) terminal.say("closest   " + sentence(plan.closest));
  if (plan.cheaper) terminal.say("cheaper   " + sentence(*plan.cheaper));
  if (plan.better) terminal.say("better    " + sentence(*plan.better));
  terminal.say(fmt::format("evidence  {} settings measured at {} pixels' width, {:.1f} s; error of the {} light",
                           plan.trials.rows.size(), options.plan.width, plan.seconds,
                           plan.indirect ? "indirect" : "whole"));
}

int run_plan(Options& options) {
  if (!options.budget) throw Error("--budget", "needed, but not given");
  options.plan.budget = *options.budget;
  const Settings base = make_settings(options.settings);
  if (!options.output.empty()) {
    require_no_clash({options.scene.file, options.settings.config, {options.output}, {}});
    require_writable(options.output);
  }
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const OpenedScene opened(options.scene, options.view, cone_bytes_per_pixel, terminal);
  const auto& [scene, view, caster] = opened;
  const Plan plan = make_plan(scene, caster, view, base, options.plan, terminal.progress());
  if (!options.output.empty() && plan.best) {
    write_text(options.output, config(plan.best->settings).dump(2) + "\n");
    terminal.say("written   " + options.output);
  }
  say(terminal, plan, options);
  terminal.result({{"budget", *options.budget},
                   {"reached", plan.best.has_value()},
                   {"plan", describe(plan.best)},
                   {"closest", describe(plan.closest)},
                   {"cheaper", describe(plan.cheaper)},
                   {"better", describe(plan.better)},
                   {"unused", plan.dropped},
                   {"of", plan.indirect ? "indirect" : "rgb"},
                   {"size", {view.width, view.height}},
                   {"seconds", plan.seconds},
                   {"trials", to_json(plan.trials)}});
  return plan.best ? exit_done : exit_outside_limits;
}

}  // namespace

void add_plan(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("plan", "the cheapest settings whose error stays within a budget");
  const auto options = std::make_shared<Options>();
  add_scene_options(*command, options->scene);
  add_value_option(*command, "--budget", "R", "the most that rel_error may be (0.2 = 20 %)",
                   [options](const std::string& text) { options->budget = parse_number("--budget", text, 1e-4, 1e6); });
  add_output_option(*command, options->output, "FILE", "writes the settings for cone --config");
  command->get_option("-o")->required(false);
  add_settings_options(*command, options->settings);
  add_view_options(*command, options->view);
  add_common_options(*command, options->common);
  command->footer(
      "Chosen are grid.resolution, bounce.count, cone.diffuse, cone.step and storage; the others are as given. Errors "
      "are\n"
      "measured on a small image against the path tracer; time and memory are predicted for --size. Exits with 1, and\n"
      "names the closest, when no setting reaches the budget. Ctrl-C writes nothing and exits with 2.\n\n"
      "Example:\n  voxref plan scenes/cornell_box_point.glb --budget 0.3 -o plan.json\n"
      "  voxref cone scenes/cornell_box_point.glb -o cone.exr --config plan.json");
  on_run(command, run, [options] { return run_plan(*options); });
}

}  // namespace voxref
