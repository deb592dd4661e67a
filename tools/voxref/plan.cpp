#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "error.h"
#include "file.h"
#include "inputs.h"
#include "json_members.h"
#include "outputs.h"
#include "parallel.h"
#include "parse.h"
#include "provenance.h"
#include "study/plan.h"
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

/// Leaves every searched parameter that --set or --config name the value that it has there.
void fix_given(SettingSpace& space, const SettingsOptions& options, const Settings& settings) {
  nlohmann::json given = options.config.empty() ? nlohmann::json::object() : read_json(options.config);
  for (const std::string& assignment : options.assignments) given[assignment.substr(0, assignment.find('='))] = true;
  for (size_t axis = 0; axis < setting_axes; ++axis) {
    std::string key = axis_parameters().at(axis);
    const bool assigned = given.contains(key);
    std::replace(key.begin(), key.end(), '.', '/');
    if (assigned || given.contains(nlohmann::json::json_pointer("/" + key))) fix(space, axis, settings);
  }
}

/// What gives `cone` these settings.
std::string flags(const Settings& settings) {
  std::string text = "--profile " + settings.profile;
  for (const std::string& assignment : assignments(settings)) text += " --set " + shell_word(assignment);
  return text;
}

std::string sentence(const PlannedSetting& setting) {
  const std::string error = setting.nonfinite > 0 ? fmt::format("no error, {} pixels are not finite", setting.nonfinite)
                                                  : fmt::format("error {:.1f} % +- {:.1f}", 100 * setting.rel_error,
                                                                100 * setting.rel_error_stderr);
  return fmt::format("{}, about {:.2g} s and {}: {}", error, setting.seconds, byte_count(setting.bytes),
                     flags(setting.settings));
}

nlohmann::json describe(const std::optional<PlannedSetting>& setting) {
  if (!setting) return nullptr;
  return {{"settings", config(setting->settings)},
          {"rel_error", setting->rel_error},
          {"rel_error_stderr", setting->rel_error_stderr},
          {"nonfinite", setting->nonfinite},
          {"seconds", setting->seconds},
          {"bytes", setting->bytes},
          {"assignments", flags(setting->settings)}};
}

void say(Terminal& terminal, const Plan& plan, const Options& options) {
  for (const std::string& line : plan.dropped) terminal.say("unused    " + line);
  for (const std::string& line : plan.not_finite) terminal.warn("voxref: warning: " + line);
  if (plan.best)
    terminal.say("plan      " + sentence(*plan.best));
  else
    terminal.say(fmt::format("plan      no setting reaches {:g} %", 100 * *options.budget));
  if (!plan.best) terminal.say("closest   " + sentence(plan.closest));
  if (plan.cheaper) terminal.say("cheaper   " + sentence(*plan.cheaper));
  if (plan.better) terminal.say("better    " + sentence(*plan.better));
  terminal.say(
      fmt::format("evidence  {} settings measured at {} pixels' width, {:.1f} s, and {:.1f} s of path tracing; error "
                  "of the {} light",
                  plan.trials.rows.size(), options.plan.width, plan.seconds, plan.reference_seconds,
                  plan.indirect ? "indirect" : "whole"));
}

int run_plan(Options& options) {
  if (!options.budget) throw Error("--budget", "needed, but not given");
  options.plan.budget = *options.budget;
  const Settings base = make_settings(options.settings);
  fix_given(options.plan.space, options.settings, base);
  if (!options.output.empty()) {
    require_no_clash({options.scene.file, options.settings.config, {options.output}, {}});
    require_writable(options.output);
  }
  const ThreadLimit threads(options.common.threads);
  Terminal terminal(options.common);
  const OpenedScene opened(options.scene, options.view, cone_bytes_per_pixel, terminal);
  const auto& [scene, view, caster] = opened;
  const Plan plan = make_plan(scene, caster, view, base, options.plan, terminal.progress());
  if (!options.output.empty()) {
    const PlannedSetting& written = plan.best ? *plan.best : plan.closest;
    write_text(options.output, config(written.settings).dump(2) + "\n");
    terminal.say("written   " + options.output + (plan.best ? "" : ", the closest"));
  }
  say(terminal, plan, options);
  terminal.result({{"budget", *options.budget},
                   {"reached", plan.best.has_value()},
                   {"plan", describe(plan.best)},
                   {"closest", describe(plan.closest)},
                   {"cheaper", describe(plan.cheaper)},
                   {"better", describe(plan.better)},
                   {"unused", plan.dropped},
                   {"not_finite", plan.not_finite},
                   {"of", plan.indirect ? "indirect" : "rgb"},
                   {"size", {view.width, view.height}},
                   {"seconds", plan.seconds},
                   {"reference_seconds", plan.reference_seconds},
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
      "Chosen are grid.resolution, bounce.count, cone.diffuse, cone.step and storage, but for those that --set or\n"
      "--config give; the others are as given. Errors are measured on a small image against the path tracer, and\n"
      "held against the budget as measured, whatever their error bars. Time and memory are predicted for --size,\n"
      "time from how long stages took on this machine, so that two runs may choose differently, and so may runs with\n"
      "other --threads, though they measure the same errors. Exits with 1, and names and writes the closest, when no\n"
      "setting reaches the budget. Ctrl-C writes nothing and exits with 2.\n\n"
      "Example:\n  voxref plan scenes/cornell_box_point.glb --budget 0.3 -o plan.json\n"
      "  voxref cone scenes/cornell_box_point.glb -o cone.exr --config plan.json");
  on_run(command, run, [options] { return run_plan(*options); });
}

}  // namespace voxref
