#include "file.h"

#include <unistd.h>

#include "catch.h"
#include "temporary_folder.h"

using namespace voxref;

TEST_CASE("What killed writers left of a file is removed, and nothing else", "[file]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "out.exr";
  // A process id beyond the largest that Linux gives.
  const std::string dead = ".out.2000000000.exr";
  // This process's own comes last: writing out.exr takes that name for a moment.
  const std::vector<std::string> others = {
      ".in.2000000000.exr",  ".out.20000x.exr", ".out..exr",
      ".out.2000000000.png", "out.exr",         ".out." + std::to_string(::getpid()) + ".exr"};
  write_text(folder.path / dead, "half");
  for (const std::string& name : others) write_text(folder.path / name, "whole");
  remove_leftovers(file);
  CHECK(!std::filesystem::exists(folder.path / dead));
  for (const std::string& name : others) {
    CAPTURE(name);
    CHECK(std::filesystem::exists(folder.path / name));
  }
}
