#include "study/table.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "catch.h"

using namespace voxref;

TEST_CASE("A table writes units, missing values and awkward words into CSV and JSON", "[study]") {
  Table table{"t", "a caption", {{"scene", ""}, {"time", "s"}, {"error", ""}}, {}};
  table.add({"box, \"small\"", 0.1, 2.0});
  table.add({std::string("plain"), std::numeric_limits<double>::quiet_NaN(), Cell{}});
  table.add({Cell{}, 3.0, Cell{}});
  table.add({std::string("#1"), Cell{}, Cell{}});
  const std::string rows = "scene,time [s],error\n\"box, \"\"small\"\"\",0.1,2\nplain,,\n,3,\n\"#1\",,\n";
  CHECK(csv(table) == rows);
  CHECK(csv(table, "made by\nhand") == "# made by\n# hand\n" + rows);
  const nlohmann::json json = to_json(table);
  CHECK(json["columns"][1] == nlohmann::json{{"name", "time"}, {"unit", "s"}});
  CHECK(json["rows"][0][1] == 0.1);
  CHECK(json["rows"][1][1].is_null());
  CHECK(table.number(0, "error") == 2.0);
  CHECK(std::isnan(table.number(0, "scene")));
  CHECK_THROWS_AS(table.add({1.0}), std::logic_error);
  CHECK_THROWS_AS(table.number(0, "nothing"), std::logic_error);
}
