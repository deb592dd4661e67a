// The template of compare/page filled with tables, and with the images as data for its script.
#include "compare/comparison_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "compare/page_data.h"
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

std::string table(const PageTable& table) {
  std::string html = "<section>\n<h2>" + escape(table.title) + "</h2>\n<div class=\"scroll\"><table>\n<thead><tr>";
  for (const std::string& column : table.head) html += "<th scope=\"col\">" + escape(column) + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += "<tr>";
    for (size_t i = 0; i < row.size(); ++i)
      html += i == 0 ? "<th scope=\"row\">" + escape(row[i]) + "</th>" : "<td>" + escape(row[i]) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table></div>\n</section>\n";
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

/// How far the page's numbers can be trusted.
std::string precision(const ComparisonPage& page, const nlohmann::json& layers) {
  const auto error = [](int bits) { return 100.0 * std::ldexp(1.0, -bits); };  // half a step of the smallest mantissa
  int bits = 8, difference_bits = 8;
  for (const nlohmann::json& layer : layers) {
    bits = std::min(bits, layer["bits"].get<int>());
    difference_bits = std::min(difference_bits, layer["difference_bits"].get<int>());
  }
  return fmt::format(
      "On this page {} and {} are to {:.1g} % of a pixel's largest channel, {} − {} is to {:.1g} % of its own.",
      page.name_a, page.name_b, error(bits), page.name_a, page.name_b, error(difference_bits));
}

}  // namespace

std::string comparison_page(const ComparisonPage& page) {
  const nlohmann::json data = page_data(page);
  const auto factor = data["factor"].get<int>();
  std::string tables;
  for (const PageTable& part : page.tables) tables += table(part);
  const char* tone = page.tone == PageTone::open ? "open" : page.tone == PageTone::good ? "good" : "bad";
  return fill(report_template_html,
              {{"style", std::string(report_template_css)},
               {"script", std::string(report_template_js)},
               {"command", escape(page.command)},
               {"title", escape(page.title)},
               {"verdict", escape(page.verdict)},
               {"verdict_class", tone},
               {"summary", escape(page.summary)},
               {"unit", escape(page.unit + " " + precision(page, data["layers"]))},
               {"name_a", escape(page.name_a)},
               {"name_b", escape(page.name_b)},
               {"size", fmt::format("{} × {} pixels{}", page.a.width(), page.a.height(),
                                    factor > 1 ? fmt::format(", shown reduced by {}", factor) : "")},
               {"tables", tables},
               {"provenance", provenance_rows(page.provenance)},
               {"data", script_json(data)}});
}

}  // namespace voxref
