#include "compare/report.h"

#include <array>

#include "compare/picture.h"
#include "compare/report_parts.h"
#include "file.h"
#include "image/image_file.h"

namespace voxref {

std::optional<bool> within_budget(const CheckReport& report) {
  if (!report.budget) return std::nullopt;
  return report.metrics.rel_error <= *report.budget;  // false for NaN
}

nlohmann::json check_result(const CheckReport& report) {
  nlohmann::json result = {
      {"path", report.path_result},     {"cone", report.cone_result}, {"metrics", to_json(report.metrics)},
      {"within_budget", nullptr},       {"budget", nullptr},          {"exposure", report.exposure},
      {"provenance", report.provenance}};
  if (report.budget) {
    result["budget"] = *report.budget;
    result["within_budget"] = *within_budget(report);
  }
  return result;
}

void write_check(const std::filesystem::path& folder, const CheckReport& report) {
  make_folder(folder);
  write_exr(folder / "cone.exr", report.cone);
  write_exr(folder / "path.exr", report.path);
  const Picture cone = display(report.cone, "", report.exposure), path = display(report.path, "", report.exposure);
  const ValueMap difference = signed_difference(report.cone, report.path);
  write_png(folder / "cone.png", cone);
  write_png(folder / "path.png", path);
  write_png(folder / "difference.png", paint_with_bar(difference, cool_warm()));
  write_png(folder / "relative_error.png", paint_with_bar(relative_error(report.cone, report.path), inferno()));
  write_png(folder / "noise.png", paint_with_bar(noise(report.path), inferno()));
  write_png(folder / "comparison.png", side_by_side(std::array{cone, path, paint(difference, cool_warm())}));
  write_text(folder / "result.json", check_result(report).dump(2) + "\n");
  write_text(folder / "report.html", report_page(report));
}

}  // namespace voxref
