#include <algorithm>
#include <filesystem>
#include <vector>

#include "catch.h"
#include "file.h"
#include "fuzz/targets.h"

namespace fs = std::filesystem;

TEST_CASE("each kept input of the fuzzers is read, or refused in one line that begins with the file", "[fuzz]") {
  for (const FuzzTarget& target : fuzz_targets) {
    std::vector<fs::path> inputs;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(VOXREF_SOURCE_DIR) / "tests/fuzz/corpus" / target.name))
      inputs.push_back(entry.path());
    std::ranges::sort(inputs);
    CHECK(!inputs.empty());
    for (const fs::path& input : inputs) {
      CAPTURE(input.string());
      CHECK(target.run(voxref::read_file(input)) == "");
    }
  }
}
