#include "study/thesis_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "study/curves.h"

namespace voxref {

std::vector<Timing> repeated(const std::function<std::vector<double>()>& round) {
  std::vector<std::vector<double>> rounds = {round()};
  const double first = std::accumulate(rounds[0].begin(), rounds[0].end(), 0.0);
  const size_t wanted = first < 1.0 ? 5 : first < 10.0 ? 3 : 1;
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

constexpr double tolerance = 2.0;  // a factor either way: other hardware, other algorithms, the same shape

const char* judged(double factor, double least, double greatest) {
  const auto within = [](double f) { return f >= 1.0 / tolerance && f <= tolerance; };
  if (within(factor)) return "agrees";
  const bool touches = least <= tolerance && greatest >= 1.0 / tolerance;
  if (touches) return "unsure";
  return factor > 1.0 ? "larger" : "smaller";
}

/// What the rows of a quantity say.
struct Verdicts {
  int agree = 0, unsure = 0, compared = 0;
  std::vector<double> larger, smaller;  ///< factors between our ratio and the published one, above 1
};

std::string range(const std::vector<double>& factors) {
  const auto [low, high] = std::minmax_element(factors.begin(), factors.end());
  return factors.size() == 1 ? fmt::format("by {:.2g}", *low) : fmt::format("by {:.2g} to {:.2g}", *low, *high);
}

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
  for (size_t i = 0; i < lines.size(); ++i) {
    const Spread &ours = lines[i].ours.spread, &one = unit.ours.spread;
    const double ratio = ours.median / one.median, least = ours.least / one.greatest,
                 greatest = ours.greatest / one.least;
    const double published = lines[i].published / unit.published, factor = ratio / published;
    const std::string shape = i == base               ? "base"
                              : std::isfinite(factor) ? judged(factor, least / published, greatest / published)
                                                      : "";
    table_.add({scene, quantity, lines[i].name, double(lines[i].ours.runs), ours.median, ours.least, ours.greatest,
                ratio, i == base ? 0.0 : 0.5 * (greatest - least), lines[i].published, published, factor, shape});
  }
}

std::string Shape::summary(std::span<const ShapeReason> reasons) const {
  std::vector<std::pair<std::string, Verdicts>> all;
  const size_t quantity = table_.column("quantity"), shape = table_.column("shape");
  for (size_t i = 0; i < table_.rows.size(); ++i) {
    const std::string name = word(table_.rows[i][quantity]), judgement = word(table_.rows[i][shape]);
    if (judgement.empty() || judgement == "base") continue;
    auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.first == name; });
    if (found == all.end()) found = all.insert(all.end(), {name, {}});
    Verdicts& v = found->second;
    const double factor = table_.number(i, "factor");
    ++v.compared;
    v.agree += judgement == "agrees";
    v.unsure += judgement == "unsure";
    if (judgement == "larger") v.larger.push_back(factor);
    if (judgement == "smaller") v.smaller.push_back(1.0 / factor);
  }
  std::string text;
  for (const auto& entry : all) {
    const std::string& name = entry.first;
    const Verdicts& v = entry.second;
    text += fmt::format("{}{}: {} of {} ratios agree with the published ones within a factor of {:g}",
                        text.empty() ? "" : "\n\n", name, v.agree, v.compared, tolerance);
    if (v.unsure > 0) text += fmt::format(", {} may or may not, by their spread", v.unsure);
    for (const bool larger : {true, false}) {
      const std::vector<double>& factors = larger ? v.larger : v.smaller;
      if (factors.empty()) continue;
      const auto reason = std::find_if(reasons.begin(), reasons.end(),
                                       [&](const ShapeReason& r) { return r.quantity == name && r.larger == larger; });
      text += fmt::format("; {} {} {} {}: {}", factors.size(), factors.size() == 1 ? "is" : "are",
                          larger ? "larger" : "smaller", range(factors),
                          reason == reasons.end() ? "no reason is known" : reason->text);
    }
    text += ".";
  }
  return text.empty() ? "Nothing was published for what was measured." : text;
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
    ours.points.push_back(chart_point(x, shape.number(i, "ratio"), "", shape.number(i, "ratio_error")));
    published.points.push_back(chart_point(x, shape.number(i, "ratio_published")));
  }
  published.color_of = title;
  return {std::move(ours), std::move(published)};
}

std::string finding(const std::string& claim, const std::vector<bool>& held, const std::string& what) {
  return fmt::format("{}: true for {} of {} {}.", claim, std::count(held.begin(), held.end(), true), held.size(), what);
}

}  // namespace voxref
