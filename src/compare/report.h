#pragma once
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "compare/metrics.h"
#include "image/image.h"

namespace voxref {

/// What a check found and from what. Plain values and JSON, so that this side knows neither renderer.
struct CheckReport {
  std::string title;             ///< what was rendered, for instance the scene's file name
  const Image& cone;             ///< as render_cones gives it
  const Image& path;             ///< as path_trace gives it, with stderr.Y
  Metrics metrics;               ///< compare(cone, path, ...)
  float exposure = 0;            ///< stops, of the pictures; the one that `metrics` was made with
  std::optional<double> budget;  ///< the most that rel_error may be, as a fraction
  nlohmann::json cone_result;    ///< object with the keys of cli.md for `cone`; the page shows `seconds` and `bytes`
  nlohmann::json path_result;    ///< object with the keys of cli.md for `path`
  nlohmann::json
      provenance;  ///< object, shown key by key: version, command_line, scene, scene_sha256, seed, spp, settings ...
};

/// Whether rel_error is within the budget; none without a budget. A rel_error that does not exist is not within.
std::optional<bool> within_budget(const CheckReport& report);

/// The one JSON object of `check` (cli.md): path, cone, metrics, within_budget; plus budget, exposure, provenance.
nlohmann::json check_result(const CheckReport& report);

/// A self-contained HTML page that opens from disk: no resource from elsewhere, below 3 MiB whatever the images' size
/// (see comparison_page.h).
std::string report_page(const CheckReport& report);

/// What write_check writes; comparison.png has cone, path and difference side by side.
inline constexpr std::array<std::string_view, 10> check_files = {
    "cone.exr",           "path.exr",  "cone.png",       "path.png",    "difference.png",
    "relative_error.png", "noise.png", "comparison.png", "result.json", "report.html"};

/// Writes check_files into the folder, which is made when it is not there.
/// @throws Error with the path of what cannot be written
void write_check(const std::filesystem::path& folder, const CheckReport& report);

}  // namespace voxref
