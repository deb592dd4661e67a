#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "options.h"
#include "progress.h"

namespace voxref {

/// Catches the first Ctrl-C as a request to stop (see Terminal::progress); a second one ends the program at once.
void catch_interrupt();

/// What a command says while it works and at its end, where the common options want it: human text on stdout, or on
/// stderr next to JSON; progress always on stderr.
class Terminal {
 public:
  explicit Terminal(const CommonOptions& options);
  ~Terminal();
  Terminal(const Terminal&) = delete;

  /// Shows work that lasts over a second: a bar with the time left on a terminal, else a line every few seconds.
  /// Cancelled by Ctrl-C. The terminal must outlive it.
  Progress progress();
  /// One line of the summary.
  void say(const std::string& line);
  /// Something the user should know besides the result; on stderr.
  void warn(const std::string& line);
  /// The result, where JSON was asked for.
  void result(const nlohmann::json& json);

 private:
  class Bar;
  CommonOptions options_;
  std::unique_ptr<Bar> bar_;
};

}  // namespace voxref
