#include "study/setting_space.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace voxref {

namespace {

std::string bounces_word(const Settings& settings) {
  return settings.bounce.count ? std::to_string(*settings.bounce.count) : "auto";
}
std::string storage_word(const Settings& settings) { return to_json(settings)["storage"]; }

}  // namespace

size_t SettingSpace::size(size_t axis) const {
  return std::array{resolutions.size(), bounces.size(), storages.size(), steps.size(), cones.size()}.at(axis);
}

std::array<const char*, setting_axes> axis_parameters() {
  return {"grid.resolution", "bounce.count", "storage", "cone.step", "cone.diffuse"};
}

void fix(SettingSpace& space, size_t axis, const Settings& settings) {
  switch (axis) {
    case resolution_axis:
      space.resolutions = {settings.grid.resolution};
      return;
    case bounce_axis:
      space.bounces = {settings.bounce.count};
      return;
    case storage_axis:
      space.storages = {settings.storage};
      return;
    case step_axis:
      space.steps = {settings.render.cone.step};
      return;
    case cone_axis:
      space.cones = {settings.render.cone.diffuse};
      return;
    default:
      throw std::out_of_range("no such axis");
  }
}

std::vector<SettingPoint> all_points(const SettingSpace& space) {
  std::vector<SettingPoint> points;
  SettingPoint point{};
  const auto each = [&](auto&& self, size_t axis) -> void {
    if (axis == setting_axes) return points.push_back(point);
    for (point[axis] = 0; point[axis] < space.size(axis); ++point[axis]) self(self, axis + 1);
  };
  each(each, 0);
  return points;
}

Settings at(const SettingSpace& space, const SettingPoint& point, Settings settings) {
  settings.grid.resolution = space.resolutions[point[resolution_axis]];
  settings.bounce.count = space.bounces[point[bounce_axis]];
  settings.storage = space.storages[point[storage_axis]];
  settings.render.cone.step = space.steps[point[step_axis]];
  settings.render.cone.diffuse = space.cones[point[cone_axis]];
  return settings;
}

std::vector<Column> setting_columns() {
  return {{"voxels", ""}, {"bounces", ""}, {"storage", ""}, {"step", ""}, {"cones", ""}};
}

std::vector<Cell> setting_cells(const Settings& settings) {
  return {double(settings.grid.resolution), bounces_word(settings), storage_word(settings),
          double(settings.render.cone.step), double(settings.render.cone.diffuse)};
}

std::string setting_words(const Settings& settings) {
  return fmt::format("{} voxels, {} bounce{}, {}, step {:g}, {} cones", settings.grid.resolution,
                     bounces_word(settings), settings.bounce.count == 1 ? "" : "s", storage_word(settings),
                     settings.render.cone.step, settings.render.cone.diffuse);
}

}  // namespace voxref
