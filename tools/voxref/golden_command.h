#pragma once
#include <map>
#include <set>
#include <string>

#include "golden_cases.h"
#include "options.h"
#include "progress.h"

namespace voxref {

/// What the command line of `golden` says.
struct GoldenOptions {
  CommonOptions common;
  std::string action, folder = "golden", scenes, failures = "golden-failures";
  uint64_t seed = golden_seed + 1;
  std::set<std::string> only;  ///< names of cases; empty: all

  std::filesystem::path scene_file(const GoldenCase& golden) const {
    return (scenes.empty() ? std::filesystem::path(folder) / ".." / "scenes" : std::filesystem::path(scenes)) /
           golden.scene;
  }
  std::filesystem::path image_file(const GoldenCase& golden) const {
    return std::filesystem::path(folder) / (golden.name + ".exr");
  }
  std::filesystem::path volume_folder(const GoldenCase& golden) const {
    return std::filesystem::path(folder) / golden.name;
  }
  std::filesystem::path index_file() const { return std::filesystem::path(folder) / "golden.json"; }
  bool wants(const GoldenCase& golden) const { return only.empty() || only.contains(golden.name); }
};

/// Renders a path or cone case: the part of the image that the set keeps.
Image render_golden(const GoldenCase& golden, const Scene& scene, uint64_t seed, int spp, const Progress& progress);
/// Writes a volume case's volumes.
void write_golden_volumes(const GoldenCase& golden, const Scene& scene, const std::filesystem::path& folder,
                          const Progress& progress);

/// What the index of the set says, by the cases' names. @throws Error with the file and the place
std::map<std::string, nlohmann::json> read_golden_index(const std::filesystem::path& file);

// Both return the exit status.
int make_goldens(const GoldenOptions& options);
int verify_goldens(const GoldenOptions& options);

}  // namespace voxref
