#include "study/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error.h"

namespace voxref {

namespace {

/// Okabe and Ito 2008, "Color Universal Design", without its yellow, which is too light on white.
constexpr std::array<const char*, 7> colors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                               "#000000", "#56B4E9", "#E69F00"};
/// gnuplot's filled symbols, then open ones.
constexpr std::array<int, 10> symbols = {7, 5, 9, 11, 13, 6, 4, 8, 10, 12};

/// In double quotes; gnuplot's markup is off.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return result + "\"";
}

bool fits(double value, const Axis& axis) { return std::isfinite(value) && (!axis.logarithmic || value > 0.0); }

bool drawable(const ChartPoint& point, const Chart& chart) { return fits(point.x, chart.x) && fits(point.y, chart.y); }

std::string range(const Axis& axis) {
  const auto end = [](const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "*"; };
  return "[" + end(axis.min) + ":" + end(axis.max) + "]";
}

/// How the names of categories stand under the axis, and how many lines they need.
struct CategoryStyle {
  std::string rotation;
  int lines = 0;
};
CategoryStyle category_style(const std::vector<std::string>& categories) {
  constexpr size_t most_letters = 70, many = 14;  // that fit side by side; names that fit when they lean
  size_t longest = 0;
  for (const std::string& name : categories) longest = std::max(longest, name.size());
  const auto length = static_cast<double>(longest);
  if (categories.size() * longest <= most_letters) return {};
  if (categories.size() <= many) return {"rotate by 30 right ", static_cast<int>(0.2 * length)};
  return {"rotate by 90 right ", static_cast<int>(0.42 * length)};
}

/// Numbers at 1, 2 and 5 too where a logarithmic axis spans few decades.
std::string fine_tics(const Axis& axis, char name) {
  if (!axis.min || !axis.max || *axis.max / *axis.min > 300.0) return "";
  std::string list;
  const auto exponent = [](double value) { return static_cast<int>(std::floor(std::log10(value))); };
  for (int e = exponent(*axis.min); e <= exponent(*axis.max); ++e)
    for (const double digit : {1.0, 2.0, 5.0})
      if (const double tic = digit * std::pow(10.0, e); tic >= *axis.min && tic <= *axis.max)
        list += fmt::format("{}{:.6g}", list.empty() ? "" : ", ", tic);
  return list.empty() ? "" : fmt::format("set {}tics ({})\n", name, list);
}

std::string axis_lines(const Axis& axis, char name) {
  std::string text =
      fmt::format("set {}label {} noenhanced\nset {}range {}\n", name, quoted(axis.title), name, range(axis));
  if (axis.logarithmic)
    text += fmt::format("set logscale {}\nset format {} \"%g\"\n", name, name) + fine_tics(axis, name);
  if (axis.categories.empty()) return text;
  text += fmt::format("set {}tics noenhanced {}font ',11' (", name, category_style(axis.categories).rotation);
  for (size_t i = 0; i < axis.categories.size(); ++i)
    text += fmt::format("{}{} {}", i > 0 ? ", " : "", quoted(axis.categories[i]), i);
  return text + ")\n";
}

/// The ends of a point's error bars; of none: the point itself. On a logarithmic axis a bar that reaches 0 ends at a
/// hundredth of the value.
struct Bars {
  Interval x, y;
};
Bars bars_of(const ChartPoint& p, const Chart& chart) {
  const auto cut = [](Interval bar, double value, const Axis& axis) {
    if (axis.logarithmic) bar.low = std::max(bar.low, 0.01 * value);
    return bar;
  };
  return {cut(p.x_bar.value_or(Interval{p.x, p.x}), p.x, chart.x),
          cut(p.y_bar.value_or(Interval{p.y - p.error, p.y + p.error}), p.y, chart.y)};
}

/// A data block: x, y, ends of y's error bar, label, base, ends of x's error bar.
std::string data_block(const Chart& chart, size_t index) {
  std::string text = fmt::format("$data{} << EOD\n", index);
  for (const ChartPoint& p : chart.series[index].points)
    if (drawable(p, chart)) {
      const Bars bars = bars_of(p, chart);
      text += fmt::format("{} {} {} {} {} {} {} {}\n", p.x, p.y, bars.y.low, bars.y.high, quoted(p.label), p.base,
                          bars.x.low, bars.x.high);
    }
  return text + "EOD\n";
}

/// Whether a series is dashes that stand beside all of the others, and for none of them.
bool is_neutral(const Series& series) { return series.style == ChartStyle::dashes && series.color_of.empty(); }

/// A series has the next colour, or that of the series that it belongs to.
std::string color_of(const Chart& chart, size_t index) {
  if (is_neutral(chart.series[index])) return "#555555";
  const std::string& wanted = chart.series[index].color_of;
  size_t own = 0;
  for (size_t i = 0; i < chart.series.size(); ++i) {
    if (wanted.empty() ? i == index : chart.series[i].title == wanted) return colors[own % colors.size()];
    if (chart.series[i].color_of.empty() && !is_neutral(chart.series[i])) ++own;
  }
  throw Error("chart", chart.name, "has no series '" + wanted + "'");
}

bool is_labelled(const Series& series) {
  return std::any_of(series.points.begin(), series.points.end(), [](const ChartPoint& p) { return !p.label.empty(); });
}

/// Where labels stand: over bars; of lines below to the right; of the first series of points below to the left, where
/// there is another, and else above: where two lines cross both can be read.
std::string label_place(const Chart& chart, size_t index) {
  const Series& series = chart.series[index];
  if (series.style == ChartStyle::bars) return "offset 0,0.7 center";
  if (series.style == ChartStyle::line) return "offset 0.4,-0.8 left";
  const bool another =
      std::any_of(chart.series.begin() + static_cast<std::ptrdiff_t>(index) + 1, chart.series.end(), is_labelled);
  return another ? "offset -0.6,-0.7 right" : "offset 0.6,0.7 left";
}

std::vector<std::string> plots(const Chart& chart, size_t index) {
  const Series& series = chart.series[index];
  const auto has = [&](const auto& test) { return std::any_of(series.points.begin(), series.points.end(), test); };
  if (!has([&](const ChartPoint& p) { return drawable(p, chart); })) return {};
  const bool errors = has([](const ChartPoint& p) { return p.error > 0.0 || p.y_bar; });
  const bool x_errors = has([](const ChartPoint& p) { return p.x_bar.has_value(); });
  const bool bars = series.style == ChartStyle::bars;
  const std::string data = fmt::format("$data{}", index), color = fmt::format("lc rgb '{}'", color_of(chart, index));
  const std::string title = series.title.empty() ? "notitle" : "title " + quoted(series.title) + " noenhanced";
  const std::string symbol = fmt::format("pt {} ps 1.1", symbols[index % symbols.size()]);
  std::vector<std::string> result;
  const auto add = [&](const std::string& columns, const std::string& style) {
    result.push_back(fmt::format("{} using {} with {} {} {}", data, columns, style, color, title));
  };
  const std::string columns = x_errors ? "1:2:7:8:3:4" : errors ? "1:2:3:4" : "1:2";
  const std::string axes = x_errors ? "xyerror" : errors ? "yerror" : "";
  switch (series.style) {
    case ChartStyle::points:
      add(columns, (axes.empty() ? "points " : axes + "bars ") + symbol);
      break;
    case ChartStyle::line:
      add("1:2", "lines lw 2");
      break;
    case ChartStyle::dashes:
      add("1:2", "lines lw 1.5 dt 2");
      break;
    case ChartStyle::line_points:
      add(columns, (axes.empty() ? "linespoints" : axes + "lines") + " lw 1.5 " + symbol);
      break;
    case ChartStyle::bars:
      add(fmt::format("1:(0.5*($2+$6)):({}):(0.5*abs($2-$6))", 0.5 * series.width), "boxxyerror fs solid 0.75");
      break;
  }
  if (bars && errors)
    result.push_back(fmt::format(
        "{} using 1:3:(0):($4-$3) with vectors heads size screen 0.004,90 lw 1.5 lc rgb 'black' notitle", data));
  if (is_labelled(series))
    result.push_back(fmt::format("{} using 1:{}:5 with labels noenhanced {} font ',9' notitle", data,
                                 bars ? "($2>$6?$2:$6)" : "2", label_place(chart, index)));
  return result;
}

/// The ends of a logarithmic axis: gnuplot's own would be whole decades. Error bars fit on it down to a tenth of the
/// least value; those that come near 0 are cut there. @param value of a point on that axis @param bar of its error
template <class Value, class Bar>
Axis fitted(Axis axis, const Chart& chart, const Value& value, const Bar& bar) {
  if (!axis.logarithmic) return axis;
  double low = std::numeric_limits<double>::infinity(), high = 0.0, least = low;
  for (const Series& series : chart.series)
    for (const ChartPoint& point : series.points)
      if (drawable(point, chart)) {
        const Interval ends = bar(bars_of(point, chart));
        least = std::min(least, value(point));
        low = std::min(low, ends.low);
        high = std::max(high, ends.high);
      }
  constexpr double margin = 1.4, longest_bar = 0.1;
  if (!axis.min) axis.min = std::max(low, longest_bar * least) / margin;
  if (!axis.max) axis.max = high * margin;
  return axis;
}

/// The lines beside the plot, and the one above it.
std::string notes(const Chart& chart) {
  std::string text;
  constexpr double top = 0.9, line = 0.036, left = 0.7;  // of the picture's height and width
  if (!chart.notes.empty()) text += fmt::format("set rmargin at screen {}\n", left - 0.02);
  for (size_t i = 0; i < chart.notes.size(); ++i)
    text += fmt::format("set label {} at screen {}, screen {:.3f} left font ',10' noenhanced\n", quoted(chart.notes[i]),
                        left, top - line * static_cast<double>(i));
  if (!chart.footer.empty())
    text += fmt::format("set label {} at screen 0.995, screen 0.985 right font ',7' tc rgb '#777777' noenhanced\n",
                        quoted(chart.footer));
  return text;
}

/// Their labels stand upright to the left of the lines, below the upper end.
std::string marks(const Chart& chart) {
  std::string text;
  for (const Mark& mark : chart.marks)
    if (fits(mark.x, chart.x))
      text += fmt::format(
          "set arrow from first {0}, graph 0 to first {0}, graph 1 nohead dt 4 lw 1.2 lc rgb '#555555'\n"
          "set label {1} at first {0}, graph 0.98 right rotate by 90 offset -1.3,0 font ',9' tc rgb '#555555' "
          "noenhanced front\n",
          mark.x, quoted(mark.label));
  return text;
}

}  // namespace

bool is_empty(const Chart& chart) {
  return std::all_of(chart.series.begin(), chart.series.end(), [&](const Series& series) {
    return std::none_of(series.points.begin(), series.points.end(),
                        [&](const ChartPoint& point) { return drawable(point, chart); });
  });
}

std::string gnuplot_script(const Chart& chart, const std::string& terminal, const std::string& output) {
  if (is_empty(chart)) throw Error("chart", chart.name, "has nothing to draw");
  constexpr size_t many = 14;  // categories that a narrow picture has room for
  const CategoryStyle categories = category_style(chart.x.categories);
  const int width = chart.notes.empty() && chart.x.categories.size() <= many ? 900 : 1200;
  const int height = 560 + 16 * categories.lines;
  std::string text =
      terminal == "svg"
          ? fmt::format("set terminal svg size {},{} font 'Helvetica,13' background rgb 'white'\n", width, height)
          : fmt::format("set terminal pngcairo size {},{} font 'Helvetica,13' fontscale 1.4 lw 1.4\n", 3 * width / 2,
                        3 * height / 2);
  text += fmt::format("set output {}\nset title {} noenhanced\n", quoted(output), quoted(chart.title));
  text += "set grid xtics ytics lt 1 lc rgb '#cccccc'\nset border 3\nset tics nomirror\n";
  const auto listed = static_cast<int>(std::count_if(chart.series.begin(), chart.series.end(),
                                                     [](const Series& series) { return !series.title.empty(); }));
  const int rows = (listed + 1) / 2;  // of the legend, which has two columns
  text += listed > 0
              ? fmt::format("set key outside below maxrows {}\nset bmargin {}\n", rows, 5 + rows + categories.lines)
              : "set key off\n";
  text += notes(chart) + marks(chart);
  const auto x = [](const auto& point_or_bars) { return point_or_bars.x; };
  const auto y = [](const auto& point_or_bars) { return point_or_bars.y; };
  text += axis_lines(fitted(chart.x, chart, x, x), 'x') + axis_lines(fitted(chart.y, chart, y, y), 'y');
  if (!chart.x.categories.empty())
    text += fmt::format("set xrange [-0.6:{}]\n", static_cast<double>(chart.x.categories.size()) - 0.4);
  std::string plot;
  for (size_t i = 0; i < chart.series.size(); ++i) {
    text += data_block(chart, i);
    for (const std::string& element : plots(chart, i)) plot += (plot.empty() ? "plot " : ", \\\n     ") + element;
  }
  return text + plot + "\n";
}

}  // namespace voxref
