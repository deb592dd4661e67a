#include "study/chart.h"

#include <fmt/format.h>

#include <cmath>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "study/gnuplot.h"
#include "temporary_folder.h"

using namespace voxref;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Chart two_points() {
  Chart chart{"two", "Two \"points\"", {"time / s", true}, {"error / %", true}, {}, {}, {}};
  chart.series.push_back({"measured", ChartStyle::line_points, {{1.0, 10.0, 2.0, "a_b"}, {10.0, 3.0, 5.0, ""}}, ""});
  return chart;
}

}  // namespace

TEST_CASE("A chart's script holds its data, and bars of error that stay on a logarithmic axis", "[study]") {
  const std::string script = gnuplot_script(two_points(), "svg", "two.svg");
  CHECK(contains(script, "set title \"Two \\\"points\\\"\" noenhanced"));
  CHECK(contains(script, "set xlabel \"time / s\""));
  CHECK(contains(script, "\n1 10 8 12 \"a_b\" 0 1 1\n"));
  CHECK(contains(script, "\n10 3 0.03 8 \"\" 0 10 10\n"));  // 3 - 5 is below 0: a hundredth of the value
}

TEST_CASE("What cannot be drawn is left out of a chart, and an empty chart is refused", "[study]") {
  Chart chart = two_points();
  chart.series[0].points.push_back({std::nan(""), 1.0, 0.0, "nan"});
  chart.series[0].points.push_back({1.0, -1.0, 0.0, "negative"});
  const std::string script = gnuplot_script(chart, "svg", "two.svg");
  CHECK(!contains(script, "\"nan\""));
  CHECK(!contains(script, "negative"));
  chart.series[0].points.clear();
  CHECK(is_empty(chart));
  CHECK_THROWS_AS(gnuplot_script(chart, "svg", "two.svg"), Error);
}

TEST_CASE("A logarithmic axis holds its error bars, but for those that come near 0", "[study]") {
  Chart chart = two_points();
  chart.series[0].points = {{1.0, 10.0, 2.0, ""}, {10.0, 3.0, 1.0, "", 0.0, Interval{5.0, 40.0}}};
  // Ends and a margin of 1.4: x from 1 to 40, y from 2 to 12.
  std::string script = gnuplot_script(chart, "svg", "two.svg");
  CHECK(contains(script, fmt::format("set xrange [{}:{}]", 1.0 / 1.4, 40.0 * 1.4)));
  CHECK(contains(script, fmt::format("set yrange [{}:{}]", 2.0 / 1.4, 12.0 * 1.4)));
  CHECK(contains(script, "xyerrorlines"));
  chart.series[0].points[1].y_bar = Interval{-1.0, 4.0};  // reaches 0: cut at a tenth of the least value
  script = gnuplot_script(chart, "svg", "two.svg");
  CHECK(contains(script, fmt::format("set yrange [{}:", 0.1 * 3.0 / 1.4)));
}

TEST_CASE("A mark is a labelled upright line, and is left out where it has no place on the axis", "[study]") {
  Chart chart = two_points();
  chart.marks = {{2.5, "breaks \"here\""}, {std::nan(""), "nowhere"}, {-1.0, "left of a logarithm"}};
  const std::string script = gnuplot_script(chart, "svg", "two.svg");
  CHECK(contains(script, "set arrow from first 2.5, graph 0 to first 2.5, graph 1 nohead"));
  CHECK(contains(script, "set label \"breaks \\\"here\\\"\" at first 2.5"));
  CHECK(!contains(script, "nowhere"));
  CHECK(!contains(script, "left of a logarithm"));
}

TEST_CASE("Theory has the colour of its measurement, and a place in the legend", "[study]") {
  Chart chart = two_points();
  chart.series.push_back({"theory", ChartStyle::dashes, {{1.0, 9.0}, {10.0, 4.0}}, "measured"});
  chart.series.push_back({"other", ChartStyle::line, {{1.0, 8.0}, {10.0, 5.0}}, ""});
  const std::string script = gnuplot_script(chart, "svg", "two.svg");
  CHECK(contains(script, "$data1 using 1:2 with lines lw 1.5 dt 2 lc rgb '#0072B2' title \"theory\""));
  CHECK(contains(script, "$data2 using 1:2 with lines lw 2 lc rgb '#D55E00' title \"other\""));
  chart.series[1].color_of = "";  // beside no one series: grey, and the colours go on without it
  const std::string neutral = gnuplot_script(chart, "svg", "two.svg");
  CHECK(contains(neutral, "$data1 using 1:2 with lines lw 1.5 dt 2 lc rgb '#555555' title \"theory\""));
  CHECK(contains(neutral, "$data2 using 1:2 with lines lw 2 lc rgb '#D55E00' title \"other\""));
  chart.series[1].color_of = "nobody";
  CHECK_THROWS_AS(gnuplot_script(chart, "svg", "two.svg"), Error);
}

TEST_CASE("What gnuplot refuses is said, and a folder's name may hold an apostrophe", "[study]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(draw(two_points(), "/bin/false", folder.path), Error);
  CHECK_THROWS_AS(draw(two_points(), folder.path / "absent", folder.path), Error);
  CHECK_THROWS_AS(require_drawing("/bin/false"), Error);
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) VOXREF_SKIP("gnuplot is not installed");
  std::filesystem::create_directory(folder.path / "it's");
  CHECK_NOTHROW(require_drawing(*gnuplot));
  draw(two_points(), *gnuplot, folder.path / "it's");
  CHECK(read_file(folder.path / "it's" / "two.png").substr(1, 3) == "PNG");
}
