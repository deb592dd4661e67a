#include "study/study_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "file.h"
#include "study/gnuplot.h"
#include "temporary_folder.h"

using namespace voxref;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Chart one_point() {
  Chart chart{"two", "One point", {"time / s", true}, {"error / %", true}, {}, {}, {}};
  chart.series.push_back({"measured", ChartStyle::points, {{1.0, 10.0}}, ""});
  return chart;
}

StudyResult small_study() {
  Table table{"numbers", "Numbers", {{"x", "m"}}, {}};
  table.add({1.5});
  return {"small",
          "a study",
          {{"part", "One.\n\nTwo < three.", {table}, {one_point()}, 0.1, {"a rung is not finite"}}},
          {"sponza: absent"},
          "voxref study small -o out"};
}

void write(const TemporaryFolder& folder, const StudyResult& result,
           const std::optional<std::filesystem::path>& gnuplot) {
  const nlohmann::json origin = {{"command_line", "voxref study all"}};
  write_tables(folder.path, result, origin);
  write_result(folder.path, std::vector{result}, origin);
  if (gnuplot) draw_charts(folder.path, result, *gnuplot);
  write_page(folder.path, std::vector{result}, origin, gnuplot.has_value());
}

}  // namespace

TEST_CASE("A study without gnuplot writes its data and a page that says so", "[study]") {
  const TemporaryFolder folder;
  write(folder, small_study(), std::nullopt);
  CHECK(read_file(folder.path / "numbers.csv") == "# voxref study small -o out  (0.1 s)\nx [m]\n1.5\n");
  const std::string page = read_file(folder.path / "report.html");
  for (const char* part : {"voxref study all", "voxref study small", "gnuplot is not installed", "Two &lt; three.",
                           "sponza: absent", "1.5", "Warning: a rung is not finite"})
    CHECK(contains(page, part));
  CHECK(nlohmann::json::parse(read_file(folder.path / "result.json"))["studies"][0]["name"] == "small");
  CHECK(!std::filesystem::exists(folder.path / "two.svg"));
}

TEST_CASE("gnuplot draws both pictures, which say how they were made", "[study]") {
  const auto gnuplot = find_gnuplot();
  if (!gnuplot) VOXREF_SKIP("gnuplot is not installed");
  const TemporaryFolder folder;
  write(folder, small_study(), gnuplot);
  CHECK(read_file(folder.path / "two.png").substr(1, 3) == "PNG");
  const std::string page = read_file(folder.path / "report.html");
  CHECK(contains(page, "<svg"));
  CHECK(!contains(page, "<?xml"));
  CHECK(contains(page, "voxref study small -o out  (0.1 s)"));
}

TEST_CASE("A chart that holds nothing is left out of a report, and named", "[study]") {
  const TemporaryFolder folder;
  StudyResult study = small_study();
  study.sections[0].charts[0].series[0].points[0].y = std::nan("");
  write(folder, study, find_gnuplot());
  CHECK(contains(read_file(folder.path / "report.html"), "No chart \"One point\": it has no point"));
  CHECK(!std::filesystem::exists(folder.path / "two.svg"));
}
