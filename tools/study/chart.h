#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace voxref {

struct Axis {
  std::string title;  ///< with its unit: "time / s"
  bool logarithmic = false;
  std::optional<double> min, max;       ///< none: as the data need
  std::vector<std::string> categories;  ///< names of the positions 0, 1, 2 ...; empty: a scale of numbers
};

struct ChartPoint {
  double x = 0, y = 0;
  double error = 0;   ///< half the length of the error bar along y; 0: none is drawn
  std::string label;  ///< beside the point; empty: none
  double base = 0;    ///< where a bar begins
};

enum class ChartStyle : uint8_t {
  points,
  line,
  dashes,  ///< a line that nobody measured: theory, a threshold
  line_points,
  bars  ///< from `base` to y
};

struct Series {
  std::string title;  ///< in the legend; empty: not listed
  ChartStyle style = ChartStyle::points;
  std::vector<ChartPoint> points;  ///< those that are not finite are left out
};

/// A chart as data. Colours are told apart by colour-blind readers (Okabe and Ito 2008), and each series has its own
/// point symbol.
struct Chart {
  std::string name;  ///< of its files, without extension
  std::string title;
  Axis x, y;
  std::vector<Series> series;
};

/// A gnuplot script that holds the data and draws the chart into `output`. @param terminal "svg" or "png"
std::string gnuplot_script(const Chart& chart, const std::string& terminal, const std::string& output);

/// Where the plotting program is; none where it is not installed (Debian: gnuplot-nox).
std::optional<std::filesystem::path> find_gnuplot();

/// Writes NAME.gnuplot, NAME.svg and NAME.png into the folder. @throws Error with gnuplot's message when it fails
void draw(const Chart& chart, const std::filesystem::path& gnuplot, const std::filesystem::path& folder);

}  // namespace voxref
