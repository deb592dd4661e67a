#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voxref {

struct Axis {
  std::string title;  ///< with its unit: "time / s"
  bool logarithmic = false;
  std::optional<double> min{}, max{};     ///< none: as the data and their error bars need
  std::vector<std::string> categories{};  ///< names of the positions 0, 1, 2 ...; empty: a scale of numbers
};

/// The ends of an error bar.
struct Interval {
  double low = 0, high = 0;
};

struct ChartPoint {
  double x = 0, y = 0;
  double error = 0;                          ///< half the length of the error bar along y; 0: none is drawn
  std::string label{};                       ///< beside the point; empty: none
  double base = 0;                           ///< where a bar begins
  std::optional<Interval> x_bar{}, y_bar{};  ///< error bars that are not symmetric; y_bar replaces `error`
};

enum class ChartStyle : uint8_t {
  points,
  line,
  dashes,  ///< a line that nobody measured: theory, a limit; grey, unless it has the colour of another series
  line_points,
  bars  ///< from `base` to y
};

struct Series {
  std::string title;  ///< in the legend; empty: not listed
  ChartStyle style = ChartStyle::points;
  std::vector<ChartPoint> points{};  ///< those that are not finite are left out
  std::string color_of{};  ///< title of the series whose colour this one shares: theory beside its measurement
  double width = 0.6;      ///< of bars, in units of x
};

/// A dashed vertical line: where something begins or ends.
struct Mark {
  double x = 0;       ///< not finite, or not above 0 where the axis is logarithmic: none is drawn
  std::string label;  ///< along the line
};

/// A chart as data. Colours are told apart by colour-blind readers (Okabe and Ito 2008), and each series has its own
/// point symbol.
struct Chart {
  std::string name;  ///< of its files, without extension
  std::string title;
  Axis x, y;
  std::vector<Series> series{};
  std::vector<Mark> marks{};         ///< within the range of the points
  std::vector<std::string> notes{};  ///< lines to the right of the plot: what short labels mean
  std::string footer{};              ///< above, small: the command that made it, and its time
};

/// Whether no point of it can be drawn: none is finite, and above 0 where an axis is logarithmic.
bool is_empty(const Chart& chart);

/// A gnuplot script that holds the data and draws the chart into `output`. @param terminal "svg" or "png"
/// @throws Error when the chart is empty
std::string gnuplot_script(const Chart& chart, const std::string& terminal, const std::string& output);

}  // namespace voxref
