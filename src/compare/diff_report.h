#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "compare/image_diff.h"
#include "compare/volume_diff.h"

namespace voxref {

// What `diff` leaves in a folder, which is made where it is not there: pictures, result.json and report.html.
// All throw Error with the path of what cannot be written.

struct ImageReport {
  const Image &a, &b;
  const ImageDiff& diff;
  nlohmann::json provenance;  ///< object
};

/// a.png, b.png, difference.png, relative_error.png, comparison.png, result.json and report.html.
void write_image_report(const std::filesystem::path& folder, const ImageReport& report);

struct VolumeReport {
  std::filesystem::path a, b;  ///< folders of volumes
  FolderDifference difference;
  std::vector<Cause> causes;
  nlohmann::json provenance;                     ///< object
  std::optional<FolderDifference> recomputed{};  ///< each stage on its own input
};

/// For every volume of both folders that differs NAME.png, the slice across z with the largest difference: a, b, and
/// the difference of the luminances; result.json; report.html, which shows the first of these slices.
void write_volume_report(const std::filesystem::path& folder, const VolumeReport& report);

}  // namespace voxref
