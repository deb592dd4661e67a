// voxref: parses the command line, runs one command, turns whatever goes wrong into one line and exit status 2.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <new>

#include "commands.h"
#include "error.h"
#include "provenance.h"
#include "terminal.h"

namespace voxref {

namespace {

int fail(std::string what) {
  std::replace(what.begin(), what.end(), '\n', ' ');  // some libraries' messages have several lines
  fmt::print(stderr, "voxref: {}\n", what);
  return 2;
}

/// What the parser found wrong, as `FLAG: what is wrong`.
Error explain(const CLI::ParseError& error) {
  const std::string what = error.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error))  // "--spp: At Most 1 required but received 2", "... missing"
    return {what.substr(0, what.find(':')),
            what.find("At Most") != std::string::npos ? "given more than once" : "needs a value"};
  if (dynamic_cast<const CLI::RequiredError*>(&error)) return {what.substr(0, what.find(' ')), "needed, but not given"};
  return Error(what);
}

int run(int argc, char* argv[]) {
  CLI::App program(
      "voxref: CPU reference for voxel cone tracing. Path traces, cone traces, and says how far they differ.",
      "voxref");
  program.set_version_flag("--version", "voxref " + version());
  program.footer(
      "Example:\n  voxref check scenes/cornell_box_point.glb -o out/cornell\n\n"
      "Exit status: 0 done and within limits, 1 done and outside, 2 could not.");
  program.allow_extras();  // so that refuse_leftovers words the error
  Run command;
  add_info(program, command);
  add_path(program, command);
  add_merge(program, command);
  add_cone(program, command);
  add_check(program, command);
  add_stage(program, command);
  add_diff(program, command);
  add_golden(program, command);
  add_study(program, command);
  add_plan(program, command);
  add_bench(program, command);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw explain(error);
    return program.exit(error);  // --help and --version
  }
  refuse_leftovers(program);
  if (!command) throw Error("command", "none given; see voxref --help");
  catch_interrupt();
  return command();
}

}  // namespace

}  // namespace voxref

int main(int argc, char* argv[]) {
  voxref::set_command_line(argc, argv);
  try {
    return voxref::run(argc, argv);
  } catch (const std::bad_alloc&) {
    return voxref::fail("no memory");
  } catch (const std::exception& error) {
    return voxref::fail(error.what());
  } catch (...) {
    return voxref::fail("unknown failure");
  }
}
