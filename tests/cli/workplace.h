#pragma once
#include <sys/wait.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "catch.h"
#include "file.h"
#include "image/image_file.h"
#include "make_scenes/builders.h"
#include "make_scenes/gltf_writer.h"
#include "temporary_folder.h"

// The real program in a folder of its own, as a script would run it.

namespace fs = std::filesystem;
using nlohmann::json;

struct Outcome {
  int status = -1;
  std::string out, err;
};

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A temporary folder in which the program runs; it holds point.glb (Cornell box, point light) and empty.gltf.
class Workplace {
 public:
  Workplace() {
    fs::create_directories(folder_.path / "run");
    voxref::write_glb(path("point.glb"), voxref::cornell_box(voxref::CornellLight::point), "for the tests");
    voxref::write_text(path("empty.gltf"), R"({"asset": {"version": "2.0"}})");
  }
  fs::path path(const std::string& name) const { return folder_.path / "run" / name; }

  /// Runs a shell's commands in the folder, the program found as `voxref`.
  Outcome shell(const std::string& commands) const {
    const std::string out = (folder_.path / "out").string(), err = (folder_.path / "err").string();
    const std::string programs = fs::path(VOXREF_PROGRAM).parent_path().string();
    const std::string line = "cd '" + path("").string() + "' && export PATH='" + programs + "':\"$PATH\" && { " +
                             commands + "; } >'" + out + "' 2>'" + err + "'";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, voxref::read_file(out), voxref::read_file(err)};
  }

  /// @param before goes in front of the program, for instance "timeout 1"
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    return shell(before + " '" VOXREF_PROGRAM "' " + arguments);
  }

  json run_json(const std::string& arguments) const {
    const Outcome outcome = run(arguments + " --json");
    INFO(arguments << "\n" << outcome.err);
    REQUIRE(outcome.status == 0);
    return json::parse(outcome.out);
  }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(path(""))) names.insert(entry.path().string());
    return names;
  }

 private:
  TemporaryFolder folder_;
};

/// Exit 2, one line that begins with "voxref: " and says `reason`, nothing on stdout, nothing written.
inline void check_refused(const Workplace& place, const std::string& arguments, const std::string& reason) {
  const std::set<std::string> before = place.files();
  const Outcome outcome = place.run(arguments);
  INFO(arguments << "\n" << outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.out == "");
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  CHECK(outcome.err.substr(0, 8) == "voxref: ");
  CHECK(contains(outcome.err, reason));
  CHECK(place.files() == before);
}

inline void check_same_bits(const voxref::Image& a, const voxref::Image& b) {
  REQUIRE(a.channels() == b.channels());
  for (const std::string& name : a.channels()) {
    CAPTURE(name);
    const auto p = a.channel(name), q = b.channel(name);
    CHECK((p.size() == q.size() && std::memcmp(p.data(), q.data(), p.size_bytes()) == 0));
  }
}

inline const std::string small_view = " --size 12x10 ";
