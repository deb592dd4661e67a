#include "commands.h"
#include "golden_command.h"
#include "parse.h"

namespace voxref {

namespace {

void require_known(const std::set<std::string>& names) {
  for (const std::string& name : names)
    if (std::ranges::none_of(golden_cases(), [&](const GoldenCase& c) { return c.name == name; }))
      throw Error("--case", "there is no case '" + name + "'");
}

}  // namespace

void add_golden(CLI::App& program, Run& run) {
  CLI::App* command =
      program.add_subcommand("golden", "writes the golden set of images and volumes, or renders it again and compares");
  const auto options = std::make_shared<GoldenOptions>();
  command
      ->add_option_function<std::string>(
          "ACTION",
          [options](const std::string& name) {
            if (name != "make" && name != "verify") throw Error("ACTION", "'" + name + "' is not make or verify");
            options->action = name;
          },
          "make (writes the set) or verify (renders it again, path-traced cases with another seed)")
      ->required()
      ->type_name("");
  command->add_option("DIR", options->folder, "folder of the set (default: golden)")->type_name("");
  add_value_option(*command, "--scenes", "DIR", "folder of the scenes (default: scenes beside the set)",
                   [options](const std::string& text) { options->scenes = text; });
  add_value_option(*command, "-o", "DIR", "verify: where a failed case leaves its report (default: golden-failures)",
                   [options](const std::string& text) { options->failures = text; });
  add_value_option(*command, "--seed", "N", "verify: of path-traced cases", [options](const std::string& text) {
    options->seed = parse_integer("--seed", text, 0, std::numeric_limits<uint64_t>::max());
    if (options->seed == golden_seed) throw Error("--seed", "is the set's own; a fresh one judges it");
  });
  command
      ->add_option_function<std::vector<std::string>>(
          "--case",
          [options](const std::vector<std::string>& names) {
            options->only = {names.begin(), names.end()};
          },
          "only this one (repeatable)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_common_options(*command, options->common);
  command->footer("Exit status: 0 all cases agree, 1 some do not, 2 could not.\n\nExample:\n  voxref golden verify");
  on_run(command, run, [options] {
    require_known(options->only);
    return options->action == "make" ? make_goldens(*options) : verify_goldens(*options);
  });
}

}  // namespace voxref
