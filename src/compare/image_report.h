#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compare/image_diff.h"

namespace voxref {

struct ImageReport {
  const Image &a, &b;
  const ImageDiff& diff;
  nlohmann::json result;      ///< object, written as result.json
  nlohmann::json provenance;  ///< object, with `a` and `b`, what was compared
};

/// What write_image_report writes.
inline constexpr std::array<std::string_view, 7> image_report_files = {
    "a.png", "b.png", "difference.png", "relative_error.png", "comparison.png", "result.json", "report.html"};

/// Writes image_report_files into a folder, which is made where it is not there.
/// @throws Error with the path of what cannot be written
void write_image_report(const std::filesystem::path& folder, const ImageReport& report);

}  // namespace voxref
