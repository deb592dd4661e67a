#include "study/thesis_shape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "study/curves.h"

namespace voxref {

std::vector<Timing> repeated(const std::function<std::vector<double>()>& round) {
  std::vector<std::vector<double>> rounds = {round()};
  const double longest = *std::max_element(rounds[0].begin(), rounds[0].end());
  const size_t wanted = longest < 1.0 ? 5 : 3;
  while (rounds.size() < wanted) rounds.push_back(round());
  std::vector<Timing> result;
  for (size_t k = 0; k < rounds[0].size(); ++k) {
    std::vector<double> values;
    for (const std::vector<double>& r : rounds) values.push_back(r[k]);
    result.push_back({spread(std::move(values)), static_cast<int>(rounds.size())});
  }
  return result;
}

namespace {

/// Logarithms of ratios: what a repetition is off, and another processor may be.
const double least_tolerance = std::log(1.1), most_tolerance = std::log(2.0);

/// Whether ratios go the same way, by how much, and how sure that is. All logarithms.
const char* judged(double published, double ours, double least, double greatest) {
  const double tolerance = std::clamp(0.5 * std::abs(published), least_tolerance, most_tolerance);
  if (!std::isfinite(ours)) return "not a number";
  if (least >= published - tolerance && greatest <= published + tolerance) return "agrees";
  if (least > published + tolerance) return "larger";
  if (greatest < published - tolerance) return "smaller";
  return "unsure";
}

/// What the rows of a quantity say.
struct Verdicts {
  int agree = 0, compared = 0, constant = 0;                  ///< constant: that a ratio of 1 would pass
  std::vector<std::string> unsure, broken;                    ///< rows
  std::map<std::string, std::vector<std::string>> differ[2];  ///< by reason: rows that are smaller, and larger
};

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string word(const Cell& cell) {
  return std::holds_alternative<std::string>(cell) ? std::get<std::string>(cell) : "";
}

}  // namespace

Shape::Shape(const std::string& name, const std::string& caption, const std::string& unit,
             const std::string& published_unit)
    : table_{name,
             caption,
             {{"scene", ""},
              {"quantity", ""},
              {"line", ""},
              {"runs", ""},
              {"median", unit},
              {"least", unit},
              {"greatest", unit},
              {"ratio", ""},
              {"ratio_error", ""},
              {"published", published_unit},
              {"ratio_published", ""},
              {"factor", ""},
              {"shape", ""}}} {}

void Shape::add_block(const std::string& scene, const std::string& quantity, const std::vector<ShapeLine>& lines,
                      size_t base) {
  const ShapeLine& unit = lines.at(base);
  const auto log_error = [](double a, double b) { return std::log(a / b); };
  for (size_t i = 0; i < lines.size(); ++i) {
    const Spread &ours = lines[i].ours.spread, &one = unit.ours.spread;
    const double ratio = ours.median / one.median, published = lines[i].published / unit.published;
    // Both spreads are errors of their own.
    const double below = std::hypot(log_error(ours.median, ours.least), log_error(one.greatest, one.median)),
                 above = std::hypot(log_error(ours.greatest, ours.median), log_error(one.median, one.least));
    const double log_ratio = std::log(ratio);
    const std::string shape = i == base ? "base"
                              : std::isnan(published)
                                  ? ""
                                  : judged(std::log(published), log_ratio, log_ratio - below, log_ratio + above);
    table_.add({scene, quantity, lines[i].name, double(lines[i].ours.runs), ours.median, ours.least, ours.greatest,
                ratio, i == base ? 0.0 : 0.5 * ratio * (std::exp(above) - std::exp(-below)), lines[i].published,
                published, ratio / published, shape});
  }
}

namespace {

/// "sponza 64"
std::string row_name(const std::string& scene, const std::string& line) {
  return scene == all_scenes ? line : scene + " " + line;
}

std::string why(std::span<const ShapeReason> reasons, const std::string& quantity, bool larger,
                const std::string& row) {
  for (const ShapeReason& reason : reasons)
    if (reason.quantity == quantity && reason.larger == larger &&
        std::find(reason.rows.begin(), reason.rows.end(), row) != reason.rows.end())
      return reason.text;
  return "why is not known";
}

std::string sentence(const std::string& quantity, const Verdicts& v) {
  std::string text =
      fmt::format("{}: {} of {} ratios agree ({} would if nothing changed)", quantity, v.agree, v.compared, v.constant);
  if (!v.unsure.empty()) text += "; unsure by their spread: " + joined(v.unsure);
  if (!v.broken.empty()) text += "; not a number: " + joined(v.broken);
  for (const bool larger : {true, false})
    for (const auto& [reason, rows] : v.differ[larger])
      text += fmt::format("; {}: {}: {}", larger ? "larger" : "smaller", joined(rows), reason);
  return text + ".";
}

}  // namespace

std::string Shape::summary(std::span<const ShapeReason> reasons) const {
  std::vector<std::pair<std::string, Verdicts>> all;
  Verdicts sum;
  for (size_t i = 0; i < table_.rows.size(); ++i) {
    const auto text_of = [&](const char* column) { return word(table_.rows[i][table_.column(column)]); };
    const std::string quantity = text_of("quantity"), shape = text_of("shape"),
                      row = row_name(text_of("scene"), text_of("line"));
    if (shape.empty() || shape == "base") continue;
    auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.first == quantity; });
    if (found == all.end()) found = all.insert(all.end(), {quantity, {}});
    const double ratio = table_.number(i, "ratio"), published = table_.number(i, "ratio_published");
    for (Verdicts* v : {&found->second, &sum}) {
      ++v->compared;
      v->agree += shape == "agrees";
      v->constant += std::abs(std::log(published)) <= least_tolerance;
      if (shape == "unsure") v->unsure.push_back(row);
      if (shape == "not a number") v->broken.push_back(row);
    }
    const bool larger = shape == "larger";
    if (!larger && shape != "smaller") continue;
    const bool turned = (ratio - 1.0) * (published - 1.0) < 0.0;
    found->second.differ[larger][why(reasons, quantity, larger, row)].push_back(
        fmt::format("{} ({:.2g} in place of {:.2g}{})", row, ratio, published, turned ? ", the other way round" : ""));
  }
  if (all.empty()) return "Nothing was published for what was measured.";
  std::string text = fmt::format(
      "{} of {} ratios agree with the published ones ({} would if nothing changed), of {} the spread leaves it open.",
      sum.agree, sum.compared, sum.constant, sum.unsure.size());
  for (const auto& [quantity, verdicts] : all) text += "\n\n" + sentence(quantity, verdicts);
  return text;
}

std::vector<Series> shape_series(const Table& shape, const std::string& scene, const std::string& quantity,
                                 const std::string& title) {
  Series ours{title, ChartStyle::line_points}, published{title + ", published", ChartStyle::dashes};
  for (size_t i = 0; i < shape.rows.size(); ++i) {
    if (word(shape.rows[i][shape.column("scene")]) != scene ||
        word(shape.rows[i][shape.column("quantity")]) != quantity)
      continue;
    const std::string line = word(shape.rows[i][shape.column("line")]);
    auto x = static_cast<double>(ours.points.size());
    std::from_chars(line.data(), line.data() + line.size(), x);
    const double error = shape.number(i, "ratio_error");
    ours.points.push_back(chart_point(x, shape.number(i, "ratio"), "", std::isfinite(error) ? error : 0.0));
    published.points.push_back(chart_point(x, shape.number(i, "ratio_published")));
  }
  published.color_of = title;
  return {std::move(ours), std::move(published)};
}

std::string finding(const std::string& claim, const std::vector<bool>& held, const std::string& what) {
  return fmt::format("{}: true for {} of {} {}.", claim, std::count(held.begin(), held.end(), true), held.size(), what);
}

}  // namespace voxref
