#pragma once
#include "options.h"

namespace voxref {

// One file per subcommand. Each adds its flags, its help with an example, and sets `run` when it is the one given.

void add_info(CLI::App& program, Run& run);
void add_path(CLI::App& program, Run& run);
void add_merge(CLI::App& program, Run& run);
void add_cone(CLI::App& program, Run& run);
void add_check(CLI::App& program, Run& run);
void add_stage(CLI::App& program, Run& run);
void add_diff(CLI::App& program, Run& run);
void add_golden(CLI::App& program, Run& run);
void add_study(CLI::App& program, Run& run);
void add_plan(CLI::App& program, Run& run);
void add_bench(CLI::App& program, Run& run);

/// Exit statuses (the third one, 2: could not do it, is main's).
inline constexpr int exit_done = 0, exit_outside_limits = 1;

}  // namespace voxref
