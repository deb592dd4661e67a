#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace voxref {

/// What a column holds. An error bar is a column of its own, named after the one that it belongs to: "bias_stderr".
struct Column {
  std::string name;  ///< lower_case
  std::string unit;  ///< empty: none
};

/// A number, a word, or nothing (what was not measured; NaN and infinity are written so too).
using Cell = std::variant<std::monostate, double, std::string>;

/// What a study measured: rows of numbers with their units.
struct Table {
  std::string name;     ///< of its files, without extension
  std::string caption;  ///< one sentence
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows{};  ///< as many cells as there are columns

  /// @throws std::logic_error when the number of cells is not that of the columns
  void add(std::vector<Cell> row);
  /// @throws std::logic_error when there is no column of that name
  size_t column(const std::string& name) const;
  /// NaN where the cell holds no number.
  double number(size_t row, const std::string& column) const;
};

/// A heading "name [unit]" and one line per row (RFC 4180); numbers with their shortest decimals.
/// @param comment goes before it, "# " at the start of each of its lines, which gnuplot skips, and pandas with
/// comment="#"; empty: none
std::string csv(const Table& table, const std::string& comment = {});
/// {name, caption, columns: [{name, unit}], rows: [[...]]}
nlohmann::json to_json(const Table& table);
/// A cell as a reader wants it: four significant digits.
std::string display(const Cell& cell);

}  // namespace voxref
