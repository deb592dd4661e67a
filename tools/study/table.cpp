#include "study/table.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace voxref {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",#\"\n") == std::string::npos) return text;  // from # on readers take it for a comment
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string heading(const Column& column) {
  return quoted(column.unit.empty() ? column.name : column.name + " [" + column.unit + "]");
}

std::string csv(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return quoted(*text);
  const auto* number = std::get_if<double>(&cell);
  return number && std::isfinite(*number) ? fmt::format("{}", *number) : "";
}

template <class Range, class Function>
std::string line(const Range& range, const Function& text) {
  std::string result, separator;
  for (const auto& element : range) {
    result += separator + text(element);
    separator = ",";
  }
  return result + "\n";
}

nlohmann::json to_json(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const auto* number = std::get_if<double>(&cell);
  return number && std::isfinite(*number) ? nlohmann::json(*number) : nlohmann::json();
}

}  // namespace

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size()) throw std::logic_error("table " + name + ": a row of the wrong length");
  rows.push_back(std::move(row));
}

size_t Table::column(const std::string& wanted) const {
  for (size_t i = 0; i < columns.size(); ++i)
    if (columns[i].name == wanted) return i;
  throw std::logic_error("table " + name + ": no column " + wanted);
}

double Table::number(size_t row, const std::string& wanted) const {
  const auto* value = std::get_if<double>(&rows.at(row).at(column(wanted)));
  return value ? *value : std::numeric_limits<double>::quiet_NaN();
}

std::string csv(const Table& table, const std::string& comment) {
  std::string text;
  std::istringstream lines(comment);
  for (std::string words; std::getline(lines, words);) text += "# " + words + "\n";
  text += line(table.columns, heading);
  for (const auto& row : table.rows) text += line(row, [](const Cell& cell) { return csv(cell); });
  return text;
}

nlohmann::json to_json(const Table& table) {
  nlohmann::json columns = nlohmann::json::array(), rows = nlohmann::json::array();
  for (const Column& column : table.columns) columns.push_back({{"name", column.name}, {"unit", column.unit}});
  for (const auto& row : table.rows) {
    nlohmann::json& cells = rows.emplace_back(nlohmann::json::array());
    for (const Cell& cell : row) cells.push_back(to_json(cell));
  }
  return {{"name", table.name}, {"caption", table.caption}, {"columns", columns}, {"rows", rows}};
}

std::string display(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const auto* number = std::get_if<double>(&cell);
  return number && std::isfinite(*number) ? fmt::format("{:.4g}", *number) : "";
}

}  // namespace voxref
