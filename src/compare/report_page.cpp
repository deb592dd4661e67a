// The page of a check: the template of compare/page filled with tables, and with the images as data for its script.
#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "compare/page_data.h"
#include "compare/report.h"
#include "compare/report_template.h"

namespace voxref {

namespace {

std::string escape(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  return result;
}

/// Replaces each {{name}} of the template; the inserted text is not searched again.
std::string fill(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
  std::string result;
  for (size_t at = 0;;) {
    const size_t open = text.find("{{", at);
    result += text.substr(at, open - at);
    if (open == std::string_view::npos) return result;
    const size_t close = text.find("}}", open);
    const auto value = values.find(text.substr(open + 2, close - open - 2));
    assert(value != values.end());
    result += value->second;
    at = close + 2;
  }
}

/// JSON inside a script element: '<' would let "</script>" end it.
std::string script_json(const nlohmann::json& json) {
  std::string result;
  for (const char c : json.dump()) c == '<' ? result += "\\u003c" : result += c;
  return result;
}

std::string number(double value, const char* format, const char* absent) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : absent;
}

std::string metric_rows(const Metrics& metrics) {
  const std::string light =
      metrics.indirect_only ? "indirect light (diffuse + specular against the path tracer's bounces)" : "all light";
  struct Row {
    const char* name;
    std::string value, meaning;
  };
  const std::array<Row, 8> rows = {{
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
  std::string html;
  for (const Row& row : rows)
    html += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td>{}</td></tr>\n", row.name,
                        row.value, escape(row.meaning));
  return html;
}

std::string bytes_text(double bytes) {
  if (bytes >= 1024.0 * 1024.0) return fmt::format("{:.1f} MiB", bytes / (1024.0 * 1024.0));
  return bytes >= 1024.0 ? fmt::format("{:.1f} KiB", bytes / 1024.0) : fmt::format("{:.0f} B", bytes);
}

std::string row(const std::string& name, const std::string& value) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td></tr>\n", escape(name), escape(value));
}

std::string time_rows(const CheckReport& report) {
  constexpr std::array<const char*, 6> stages = {"voxelize", "shade", "mipmap", "bounce", "cone_trace", "total"};
  const nlohmann::json seconds = report.cone_result.value("seconds", nlohmann::json::object());
  std::string html;
  for (const char* stage : stages)
    if (seconds.contains(stage)) html += row(stage, fmt::format("{:.3f} s", seconds[stage].get<double>()));
  if (report.path_result.contains("seconds"))
    html += row("path tracing", fmt::format("{:.3f} s", report.path_result["seconds"].get<double>()));
  return html;
}

std::string byte_rows(const CheckReport& report) {
  std::string html;
  const nlohmann::json bytes = report.cone_result.value("bytes", nlohmann::json::object());
  for (const auto& [volume, count] : bytes.items())
    if (volume != "total") html += row(volume, bytes_text(count.get<double>()));
  if (bytes.contains("total")) html += row("total", bytes_text(bytes["total"].get<double>()));
  return html;
}

std::string provenance_rows(const nlohmann::json& provenance) {
  std::string html;
  for (const auto& [key, value] : provenance.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump(value.is_structured() ? 2 : -1);
    html +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(key),
                    value.is_structured() ? "<details><summary>show</summary><pre>" + escape(text) + "</pre></details>"
                                          : "<code>" + escape(text) + "</code>");
  }
  return html;
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
  const nlohmann::json data = page_data(report);
  const auto factor = data["factor"].get<int>();
  return fill(report_template_html,
              {{"style", std::string(report_template_css)},
               {"script", std::string(report_template_js)},
               {"title", escape(report.title)},
               {"verdict", verdict(report)},
               {"verdict_class", !within   ? "open"
                                 : *within ? "good"
                                           : "bad"},
               {"summary", escape(summary(report))},
               {"size", fmt::format("{} × {} pixels{}", report.cone.width(), report.cone.height(),
                                    factor > 1 ? fmt::format(", shown reduced by {}", factor) : "")},
               {"metrics", metric_rows(report.metrics)},
               {"times", time_rows(report)},
               {"bytes", byte_rows(report)},
               {"provenance", provenance_rows(report.provenance)},
               {"data", script_json(data)}});
}

}  // namespace voxref
