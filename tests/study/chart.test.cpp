#include "study/chart.h"

#include <cmath>

#include "catch.h"
#include "error.h"
#include "file.h"
#include "study/study_report.h"
#include "temporary_folder.h"

#include <nlohmann/json.hpp>

using namespace voxref;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Chart two_points() {
  Chart chart{"two", "Two \"points\"", {"time / s", true, {}, {}, {}}, {"error / %", true, {}, {}, {}}, {}};
  chart.series.push_back({"measured", ChartStyle::line_points, {{1.0, 10.0, 2.0, "a_b"}, {10.0, 3.0, 5.0, ""}}});
  return chart;
}

StudyResult small_study() {
  Table table{"numbers", "Numbers", {{"x", "m"}}, {}};
  table.add({1.5});
  return {"small", "a study", {{"part", "One.\n\nTwo < three.", {table}, {two_points()}, 0.1}}, {"sponza: absent"}};
}

}  // namespace

TEST_CASE("A chart's script holds its data, and bars of error that stay on a logarithmic axis", "[study]") {
  const std::string script = gnuplot_script(two_points(), "svg", "two.svg");
  CHECK(contains(script, "set title \"Two \\\"points\\\"\" noenhanced"));
  CHECK(contains(script, "set xlabel \"time / s\""));
  CHECK(contains(script, "\n1 10 8 12 \"a_b\" 0\n"));
  CHECK(contains(script, "\n10 3 0.03 8 \"\" 0\n"));  // 3 - 5 is below 0: a hundredth of the value
}

TEST_CASE("What cannot be drawn is left out of a chart, and an empty chart is refused", "[study]") {
  Chart chart = two_points();
  chart.series[0].points.push_back({std::nan(""), 1.0, 0.0, "nan"});
  chart.series[0].points.push_back({1.0, -1.0, 0.0, "negative"});
  const std::string script = gnuplot_script(chart, "svg", "two.svg");
  CHECK(!contains(script, "\"nan\""));
  CHECK(!contains(script, "negative"));
  chart.series[0].points.clear();
  CHECK_THROWS_AS(gnuplot_script(chart, "svg", "two.svg"), Error);
}

TEST_CASE("A study without gnuplot writes its data and a page that says so", "[study]") {
  const TemporaryFolder folder;
  const std::vector<StudyResult> results = {small_study()};
  write_studies(folder.path, results, {{"command_line", "voxref study small"}}, std::nullopt);
  CHECK(read_file(folder.path / "numbers.csv") == "x [m]\n1.5\n");
  const std::string page = read_file(folder.path / "report.html");
  for (const char* part :
       {"voxref study small", "gnuplot is not installed", "Two &lt; three.", "sponza: absent", "1.5"})
    CHECK(contains(page, part));
  CHECK(nlohmann::json::parse(read_file(folder.path / "result.json"))["studies"][0]["name"] == "small");
  CHECK(!std::filesystem::exists(folder.path / "two.svg"));
}

TEST_CASE("gnuplot draws both pictures, and what it refuses is said", "[study]") {
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) VOXREF_SKIP("gnuplot is not installed");
  const TemporaryFolder folder;
  const std::vector<StudyResult> results = {small_study()};
  write_studies(folder.path, results, {{"command_line", "voxref study small"}}, gnuplot);
  CHECK(read_file(folder.path / "two.png").substr(1, 3) == "PNG");
  const std::string page = read_file(folder.path / "report.html");
  CHECK(contains(page, "<svg"));
  CHECK(!contains(page, "<?xml"));
  CHECK_THROWS_AS(draw(two_points(), "/bin/false", folder.path), Error);
}
