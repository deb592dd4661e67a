// The one file that starts the plotting program.
#include "study/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "error.h"
#include "file.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

/// Runs a program with one argument, no shell between. @param messages file that takes what it says on stderr
/// @returns whether it ended with status 0
bool run_program(const fs::path& program, std::string argument, const fs::path& messages) {
  std::string name = program.string();
  std::array<char*, 3> arguments = {name.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t process = 0;
  const int failure = posix_spawn(&process, name.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw Error(name, std::strerror(failure));
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) throw Error(name, std::strerror(errno));
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void run_gnuplot(const fs::path& gnuplot, const std::string& script, const std::string& name) {
  const ScratchFolder folder;
  const fs::path file = folder.path() / "script", messages = folder.path() / "messages";
  write_text(file, script);
  if (run_program(gnuplot, file.string(), messages)) return;
  std::string said = read_file(messages);
  std::replace(said.begin(), said.end(), '\n', ' ');
  throw Error("gnuplot", name, said.empty() ? "failed without a message" : said);
}

}  // namespace

std::optional<fs::path> find_gnuplot() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / "gnuplot"; ::access(file.c_str(), X_OK) == 0) return file;
  return std::nullopt;
}

void require_drawing(const fs::path& gnuplot) {
  const ScratchFolder folder;
  Chart chart{"trial", "trial", {"x"}, {"y"}};
  chart.series.push_back({"a point", ChartStyle::points, {{1.0, 1.0}}});
  draw(chart, gnuplot, folder.path());
}

void draw(const Chart& chart, const fs::path& gnuplot, const fs::path& folder) {
  const fs::path file = folder / chart.name;
  write_text(file.string() + ".gnuplot", gnuplot_script(chart, "svg", chart.name + ".svg"));
  for (const std::string terminal : {"svg", "png"})
    write_atomically(file.string() + "." + terminal, [&](const fs::path& temporary) {
      run_gnuplot(gnuplot, gnuplot_script(chart, terminal, temporary.string()), chart.name);
    });
}

}  // namespace voxref
