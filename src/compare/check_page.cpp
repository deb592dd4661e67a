// The page of a check: what it says and which tables it shows.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "compare/comparison_page.h"
#include "compare/report.h"

namespace voxref {

namespace {

std::string number(double value, const char* format, const char* absent) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : absent;
}

PageTable metric_table(const Metrics& metrics) {
  const std::string light =
      metrics.indirect_only ? "indirect light (diffuse + specular against the path tracer's bounces)" : "all light";
  return {
      "Metrics",
      {"metric", "value", "what it says"},
      {
          {"rel_error", number(100.0 * metrics.rel_error, "{:.2f} %", "undefined"),
           "RMS difference of luminance over the path-traced mean, the path tracer's own noise taken out; of " + light},
          {"mean_ratio", number(metrics.mean_ratio, "{:.4f}", "undefined"),
           "mean cone-traced luminance over mean path-traced luminance, 1 is right; of " + light},
          {"noise_share", number(100.0 * metrics.noise_share, "{:.2f} %", "undefined"),
           "how much of the mean squared difference is the path tracer's noise; above half, trace more samples"},
          {"rmse", number(metrics.rmse, "{:.5g}", "undefined"),
           "root mean square difference of R, G, B, radiance in W/(sr m²)"},
          {"relmse", number(metrics.relmse, "{:.5g}", "undefined"),
           std::string("relative mean square error, ") + Metrics::relmse_formula},
          {"psnr", number(metrics.psnr, "{:.2f} dB", std::isinf(metrics.psnr) ? "infinite" : "undefined"),
           "peak signal-to-noise ratio of the pictures as displayed; above 40 dB is hard to see"},
          {"ssim", number(metrics.ssim, "{:.4f}", "undefined"),
           "structural similarity of the pictures as displayed (Wang et al. 2004), 1 is equal"},
          {"flip", number(metrics.flip, "{:.4f}", "undefined"),
           "mean difference seen when flipping between the pictures (LDR-FLIP, Andersson et al. 2020, 67 pixels per "
           "degree), 0 is equal"},
      }};
}

std::string bytes_text(double bytes) {
  if (bytes >= 1024.0 * 1024.0) return fmt::format("{:.1f} MiB", bytes / (1024.0 * 1024.0));
  return bytes >= 1024.0 ? fmt::format("{:.1f} KiB", bytes / 1024.0) : fmt::format("{:.0f} B", bytes);
}

PageTable time_table(const CheckReport& report) {
  constexpr std::array<const char*, 6> stages = {"voxelize", "shade", "mipmap", "bounce", "cone_trace", "total"};
  const nlohmann::json seconds = report.cone_result.value("seconds", nlohmann::json::object());
  PageTable table{"Time", {"stage", "seconds"}, {}};
  for (const char* stage : stages)
    if (seconds.contains(stage)) table.rows.push_back({stage, fmt::format("{:.3f} s", seconds[stage].get<double>())});
  if (report.path_result.contains("seconds"))
    table.rows.push_back({"path tracing", fmt::format("{:.3f} s", report.path_result["seconds"].get<double>())});
  return table;
}

PageTable byte_table(const CheckReport& report) {
  PageTable table{"Memory", {"volume", "bytes"}, {}};
  const nlohmann::json bytes = report.cone_result.value("bytes", nlohmann::json::object());
  for (const auto& [volume, count] : bytes.items())
    if (volume != "total") table.rows.push_back({volume, bytes_text(count.get<double>())});
  if (bytes.contains("total")) table.rows.push_back({"total", bytes_text(bytes["total"].get<double>())});
  return table;
}

std::string verdict(const CheckReport& report) {
  const std::optional<bool> within = within_budget(report);
  if (!within) return "no budget given";
  return *within ? "within budget" : "over budget";
}

std::string summary(const CheckReport& report) {
  const Metrics& metrics = report.metrics;
  if (metrics.nonfinite_cone + metrics.nonfinite_path > 0)
    return fmt::format(
        "{} cone-traced and {} path-traced pixels are NaN or infinite, the first at {}: no metric exists.",
        metrics.nonfinite_cone, metrics.nonfinite_path, metrics.first_nonfinite);
  if (!std::isfinite(metrics.mean_ratio)) return "The path-traced image is black.";
  const double percent = 100.0 * (metrics.mean_ratio - 1.0);
  std::string text = fmt::format("The cone tracer's {} is ", metrics.indirect_only ? "indirect light" : "light");
  text += std::abs(percent) < 0.05
              ? "as bright as"
              : fmt::format("{:.1f} % {} than", std::abs(percent), percent < 0.0 ? "darker" : "brighter");
  text += " the path tracer's in the mean";
  text += fmt::format(" and {:.1f} % off per pixel (RMS, noise taken out)", 100.0 * metrics.rel_error);
  if (report.budget) text += fmt::format("; the budget is {:g} %", 100.0 * *report.budget);
  return text + ".";
}

}  // namespace

std::string report_page(const CheckReport& report) {
  const std::optional<bool> within = within_budget(report);
  return comparison_page({.command = "voxref check",
                          .title = report.title,
                          .verdict = verdict(report),
                          .tone = !within   ? PageTone::open
                                  : *within ? PageTone::good
                                            : PageTone::bad,
                          .summary = summary(report),
                          .unit = "Radiance in W/(sr m²), exact in the EXR files beside this page.",
                          .name_a = "cone",
                          .name_b = "path",
                          .a = report.cone,
                          .b = report.path,
                          .exposure = report.exposure,
                          .layers = {{"total", {""}, {""}},
                                     {"indirect", {"diffuse", "specular"}, {"indirect"}},
                                     {"direct", {"direct"}, {"direct"}}},
                          .tables = {metric_table(report.metrics), time_table(report), byte_table(report)},
                          .provenance = report.provenance});
}

}  // namespace voxref
