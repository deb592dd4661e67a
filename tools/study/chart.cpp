#include "study/chart.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "error.h"
#include "file.h"

namespace voxref {

namespace {

namespace fs = std::filesystem;

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

bool drawable(const ChartPoint& point, const Chart& chart) {
  const auto fits = [](double value, const Axis& axis) {
    return std::isfinite(value) && (!axis.logarithmic || value > 0.0);
  };
  return fits(point.x, chart.x) && fits(point.y, chart.y);
}

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
  return {"rotate by 90 right ", static_cast<int>(0.48 * length)};
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

/// A data block: x, y, error, label, base; an error bar on a logarithmic axis stays above 0.
std::string data_block(const Chart& chart, size_t index) {
  std::string text = fmt::format("$data{} << EOD\n", index);
  for (const ChartPoint& p : chart.series[index].points)
    if (drawable(p, chart)) {
      const double low = chart.y.logarithmic ? std::max(p.y - p.error, 0.01 * p.y) : p.y - p.error;
      text += fmt::format("{} {} {} {} {} {}\n", p.x, p.y, low, p.y + p.error, quoted(p.label), p.base);
    }
  return text + "EOD\n";
}

/// Labels of lines stand below their points, others above: where a line runs through points both can be read.
std::string label_offset(ChartStyle style) { return style == ChartStyle::line ? "0.4,-0.8" : "0.6,0.7"; }

std::vector<std::string> plots(const Chart& chart, size_t index) {
  const Series& series = chart.series[index];
  const auto has = [&](const auto& test) { return std::any_of(series.points.begin(), series.points.end(), test); };
  if (!has([&](const ChartPoint& p) { return drawable(p, chart); })) return {};
  const bool errors = has([](const ChartPoint& p) { return p.error > 0.0; });
  const bool bars = series.style == ChartStyle::bars;
  const std::string data = fmt::format("$data{}", index),
                    color = fmt::format("lc rgb '{}'", colors[index % colors.size()]);
  const std::string title = series.title.empty() ? "notitle" : "title " + quoted(series.title) + " noenhanced";
  const std::string symbol = fmt::format("pt {} ps 1.1", symbols[index % symbols.size()]);
  std::vector<std::string> result;
  const auto add = [&](const std::string& columns, const std::string& style) {
    result.push_back(fmt::format("{} using {} with {} {} {}", data, columns, style, color, title));
  };
  switch (series.style) {
    case ChartStyle::points:
      add(errors ? "1:2:3:4" : "1:2", (errors ? "yerrorbars " : "points ") + symbol);
      break;
    case ChartStyle::line:
      add("1:2", "lines lw 2");
      break;
    case ChartStyle::dashes:
      add("1:2", "lines lw 1.5 dt 2");
      break;
    case ChartStyle::line_points:
      add(errors ? "1:2:3:4" : "1:2", (errors ? "yerrorlines lw 1.5 " : "linespoints lw 1.5 ") + symbol);
      break;
    case ChartStyle::bars:
      add("1:(0.5*($2+$6)):(0.3):(0.5*abs($2-$6))", "boxxyerror fs solid 0.75");
      break;
  }
  if (bars && errors)
    result.push_back(fmt::format(
        "{} using 1:3:(0):($4-$3) with vectors heads size screen 0.004,90 lw 1.5 lc rgb 'black' notitle", data));
  if (has([](const ChartPoint& p) { return !p.label.empty(); }))
    result.push_back(fmt::format("{} using 1:{}:5 with labels noenhanced offset {} left font ',9' notitle", data,
                                 bars ? "($2>$6?$2:$6)" : "2", label_offset(series.style)));
  return result;
}

/// The ends of a logarithmic axis: gnuplot's own would be whole decades. @param value of a point on that axis
template <class Value>
Axis fitted(Axis axis, const Chart& chart, const Value& value) {
  if (!axis.logarithmic) return axis;
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const Series& series : chart.series)
    for (const ChartPoint& point : series.points)
      if (drawable(point, chart)) {
        low = std::min(low, value(point));
        high = std::max(high, value(point));
      }
  constexpr double margin = 1.4;
  if (!axis.min) axis.min = low / margin;
  if (!axis.max) axis.max = high * margin;
  return axis;
}

/// @param file goes to gnuplot as an argument, not through a shell's eyes
void run_gnuplot(const fs::path& gnuplot, const std::string& script, const std::string& name) {
  const fs::path folder = fs::temp_directory_path();
  std::string file = (folder / "voxref-XXXXXX").string();
  const int descriptor = mkstemp(file.data());
  if (descriptor < 0) throw Error(folder.string(), "takes no files");
  close(descriptor);
  const std::string messages = file + ".messages";
  write_text(file, script);
  const std::string line = "'" + gnuplot.string() + "' '" + file + "' 2>'" + messages + "'";
  const int status = std::system(line.c_str());
  std::string said = read_file(messages);
  fs::remove(file);
  fs::remove(messages);
  std::replace(said.begin(), said.end(), '\n', ' ');
  if (status != 0) throw Error("gnuplot", name, said);
}

}  // namespace

std::string gnuplot_script(const Chart& chart, const std::string& terminal, const std::string& output) {
  std::string text = terminal == "svg"
                         ? "set terminal svg size 900,560 font 'Helvetica,13' background rgb 'white'\n"
                         : "set terminal pngcairo size 1350,840 font 'Helvetica,13' fontscale 1.4 lw 1.4\n";
  text += fmt::format("set output {}\nset title {} noenhanced\n", quoted(output), quoted(chart.title));
  text += "set grid xtics ytics lt 1 lc rgb '#cccccc'\nset border 3\nset tics nomirror\n";
  const auto listed = static_cast<int>(std::count_if(chart.series.begin(), chart.series.end(),
                                                     [](const Series& series) { return !series.title.empty(); }));
  const int rows = (listed + 1) / 2;  // of the legend, which has two columns
  text += listed > 0 ? fmt::format("set key outside below maxrows {}\nset bmargin {}\n", rows,
                                   5 + rows + category_style(chart.x.categories).lines)
                     : "set key off\n";
  text += axis_lines(fitted(chart.x, chart, [](const ChartPoint& p) { return p.x; }), 'x');
  text += axis_lines(fitted(chart.y, chart, [](const ChartPoint& p) { return p.y; }), 'y');
  if (!chart.x.categories.empty())
    text += fmt::format("set xrange [-0.6:{}]\n", static_cast<double>(chart.x.categories.size()) - 0.4);
  std::string plot;
  for (size_t i = 0; i < chart.series.size(); ++i) {
    text += data_block(chart, i);
    for (const std::string& element : plots(chart, i)) plot += (plot.empty() ? "plot " : ", \\\n     ") + element;
  }
  if (plot.empty()) throw Error("chart", chart.name, "has nothing to draw");
  return text + plot + "\n";
}

std::optional<fs::path> find_gnuplot() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / "gnuplot"; ::access(file.c_str(), X_OK) == 0) return file;
  return std::nullopt;
}

void draw(const Chart& chart, const fs::path& gnuplot, const fs::path& folder) {
  const fs::path file = folder / chart.name;
  write_text(file.string() + ".gnuplot", gnuplot_script(chart, "svg", chart.name + ".svg"));
  for (const std::string terminal : {"svg", "png"})
    write_atomically(file.string() + "." + terminal, [&](const fs::path& temporary) {
      run_gnuplot(gnuplot, gnuplot_script(chart, terminal, temporary.string()), chart.name);
    });
}

}  // namespace voxref
