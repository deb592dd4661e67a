#include "study/study_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "file.h"
#include "study/gnuplot.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

constexpr const char* style = R"(
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #1a1a1a;
       background: #fff; }
h1 { font-size: 1.6rem } h2 { margin-top: 3rem; border-bottom: 1px solid #ccc } h3 { margin-top: 2rem }
figure { margin: 1rem 0 } svg { width: 100%; height: auto }
table { border-collapse: collapse; font-size: 13px; margin: .5rem 0 }
th, td { padding: .15rem .6rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap }
th { background: #f2f2f2 } td.word { text-align: left }
.wide { overflow-x: auto } .meta { color: #555; font-size: 13px } code { background: #f2f2f2; padding: 0 .2rem }
)";

std::string escape(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

std::string paragraphs(const std::string& text) {
  std::string html;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find("\n\n", begin), text.size());
    html += "<p>" + escape(text.substr(begin, end - begin)) + "</p>\n";
    begin = end + 2;
  }
  return html;
}

std::string table_html(const Table& table) {
  std::string html = fmt::format(
      "<details{}><summary>{} ({} rows, <code>{}.csv</code>)</summary>\n<div class=\"wide\">"
      "<table><tr>",
      table.rows.size() <= 24 ? " open" : "", escape(table.caption), table.rows.size(), escape(table.name));
  for (const Column& c : table.columns)
    html += "<th>" + escape(c.name) + (c.unit.empty() ? "" : "<br>" + escape(c.unit)) + "</th>";
  html += "</tr>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const Cell& cell : row)
      html += (std::holds_alternative<std::string>(cell) ? "<td class=\"word\">" : "<td>") + escape(display(cell)) +
              "</td>";
    html += "</tr>\n";
  }
  return html + "</table></div></details>\n";
}

/// The drawing without the XML head, which has no place inside a page.
std::string figure_html(const fs::path& svg) {
  const std::string text = read_file(svg);
  return "<figure>" + text.substr(std::min(text.find("<svg"), text.size())) + "</figure>\n";
}

std::string section_html(const Section& section, const fs::path& folder, bool charts) {
  std::string html = "<h3>" + escape(section.title) + "</h3>\n";
  for (const std::string& warning : section.warnings)
    html += "<p><strong>Warning: " + escape(warning) + "</strong></p>\n";
  html += paragraphs(section.text);
  for (const Chart& chart : section.charts)
    if (is_empty(chart))
      html += "<p>No chart \"" + escape(chart.title) + "\": it has no point to draw.</p>\n";
    else if (charts)
      html += figure_html(folder / (chart.name + ".svg"));
  for (const Table& table : section.tables) html += table_html(table);
  return html + fmt::format("<p class=\"meta\">Took {:.1f} s.</p>\n", section.seconds);
}

std::string page(const fs::path& folder, std::span<const StudyResult> results, const nlohmann::json& provenance,
                 bool charts) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>voxref study"
      "</title><style>{}</style></head><body>\n<h1>voxref study</h1>\n",
      style);
  html += "<p class=\"meta\">Made by <code>" + escape(provenance.value("command_line", "")) + "</code>, version " +
          escape(provenance.value("version", "")) + ", on " + escape(provenance.value("machine", "")) + ".</p>\n";
  if (!charts) html += "<p>Without charts: gnuplot is not installed.</p>\n";
  for (const StudyResult& result : results) {
    html += "<h2>" + escape(result.name) + ": " + escape(result.title) + "</h2>\n";
    html += "<p class=\"meta\">Made by <code>" + escape(result.command) + "</code></p>\n";
    for (const std::string& skipped : result.skipped) html += "<p>Skipped: " + escape(skipped) + "</p>\n";
    for (const Section& section : result.sections) html += section_html(section, folder, charts);
  }
  return html + "</body></html>\n";
}

/// How a figure came about, as it stands on it.
std::string made_by(const StudyResult& result, const Section& section) {
  return fmt::format("{}  ({:.{}g} s)", result.command, section.seconds, section.seconds < 10.0 ? 2 : 6);
}

}  // namespace

nlohmann::json study_result(std::span<const StudyResult> results, const nlohmann::json& provenance) {
  nlohmann::json list = nlohmann::json::array();
  for (const StudyResult& result : results) {
    nlohmann::json sections = nlohmann::json::array();
    for (const Section& section : result.sections) {
      nlohmann::json tables = nlohmann::json::array(), charts = nlohmann::json::array();
      for (const Table& table : section.tables) tables.push_back(to_json(table));
      for (const Chart& chart : section.charts) charts.push_back(chart.name);
      sections.push_back({{"title", section.title},
                          {"text", section.text},
                          {"tables", tables},
                          {"charts", charts},
                          {"warnings", section.warnings},
                          {"seconds", section.seconds}});
    }
    list.push_back({{"name", result.name},
                    {"title", result.title},
                    {"command", result.command},
                    {"skipped", result.skipped},
                    {"sections", sections}});
  }
  return {{"provenance", provenance}, {"studies", list}};
}

void write_tables(const fs::path& folder, const StudyResult& result, const nlohmann::json& provenance) {
  fs::create_directories(folder);
  for (const Section& section : result.sections)
    for (const Table& table : section.tables) {
      write_text(folder / (table.name + ".csv"), csv(table, made_by(result, section)));
      nlohmann::json json = to_json(table);
      json["provenance"] = provenance;
      json["command"] = result.command;
      json["seconds"] = section.seconds;
      write_text(folder / (table.name + ".json"), json.dump(1) + "\n");
    }
}

void draw_charts(const fs::path& folder, const StudyResult& result, const fs::path& gnuplot) {
  for (const Section& section : result.sections)
    for (Chart chart : section.charts) {
      chart.footer = made_by(result, section);
      if (!is_empty(chart)) draw(chart, gnuplot, folder);
    }
}

void write_result(const fs::path& folder, std::span<const StudyResult> results, const nlohmann::json& provenance) {
  write_text(folder / "result.json", study_result(results, provenance).dump(1) + "\n");
}

void write_page(const fs::path& folder, std::span<const StudyResult> results, const nlohmann::json& provenance,
                bool charts) {
  write_text(folder / "report.html", page(folder, results, provenance, charts));
}

}  // namespace voxref
