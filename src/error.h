#pragma once
#include <stdexcept>
#include <string>

namespace voxref {

/// Input that cannot be used: a file, a flag, a size. The message reads `FILE: PLACE: what is wrong`, or
/// `PLACE: what is wrong` where there is no file, on one line. `main` catches it once and exits with status 2.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what) : std::runtime_error(what) {}
  Error(const std::string& place, const std::string& what) : std::runtime_error(place + ": " + what) {}
  Error(const std::string& file, const std::string& place, const std::string& what)
      : std::runtime_error(file + ": " + place + ": " + what) {}
};

/// The user asked a computation to stop (Ctrl-C) before it had a result.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted", "stopped before there was a result; nothing written") {}
};

}  // namespace voxref
