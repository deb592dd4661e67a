#include "study/setting_space.h"

#include <nlohmann/json.hpp>
#include <set>

#include "catch.h"

using namespace voxref;

TEST_CASE("A space of settings holds every combination once, those of one volume side by side", "[plan]") {
  const SettingSpace space{{16, 32}, {0, std::nullopt}, {Storage::unorm8, Storage::float32}, {1.0f, 0.5f}, {4, 6, 9}};
  const std::vector<SettingPoint> points = all_points(space);
  CHECK(points.size() == 2 * 2 * 2 * 2 * 3);
  CHECK(std::set(points.begin(), points.end()).size() == points.size());
  std::set<std::string> settings;
  for (const SettingPoint& point : points) settings.insert(to_json(at(space, point, {})).dump());
  CHECK(settings.size() == points.size());
  for (size_t i = 0; i + 2 < points.size(); i += 3)
    for (const size_t j : {i + 1, i + 2}) {
      SettingPoint same = points[j];
      same[cone_axis] = points[i][cone_axis];
      CHECK(same == points[i]);
    }
}

TEST_CASE("A setting's cells and words tell it from others", "[plan]") {
  const SettingSpace space;
  Settings base;
  base.grid.cubic = true;
  const Settings settings = at(space, {1, 1, 0, 1, 2}, base);
  CHECK(settings.grid.cubic);
  CHECK(setting_cells(settings) == std::vector<Cell>{64.0, "1", "unorm8", 0.5, 9.0});
  CHECK(setting_cells(settings).size() == setting_columns().size());
  CHECK(setting_words(settings) == "64 voxels, 1 bounce, unorm8, step 0.5, 9 cones");
  CHECK(setting_words(at(space, {1, 4, 2, 0, 0}, base)) == "64 voxels, auto bounces, float32, step 1, 4 cones");
}

TEST_CASE("An axis that is fixed has the settings' value under its parameter's name", "[study]") {
  // Values beside all defaults, written as --set has them.
  const std::array<const char*, setting_axes> values = {"48", "5", "float16", "0.25", "12"};
  SettingSpace all;
  Settings settings;
  for (size_t axis = 0; axis < setting_axes; ++axis) {
    apply_assignment(settings, std::string(axis_parameters()[axis]) + "=" + values[axis]);
    SettingSpace one;
    fix(one, axis, settings);
    CHECK(all_points(one).size() == all_points({}).size() / SettingSpace{}.size(axis));
    CHECK(display(setting_cells(at(one, {}, {}))[axis]) == values[axis]);
    fix(all, axis, settings);
  }
  REQUIRE(all_points(all).size() == 1);
  CHECK(setting_words(at(all, {}, {})) == "48 voxels, 5 bounces, float16, step 0.25, 12 cones");
}
