#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "settings.h"
#include "study/table.h"

namespace voxref {

/// The values of the parameters that trade time for accuracy, coarse to fine; their product is the space. The order of
/// the axes is that in which stages use them: settings that agree in all but the last share one volume.
struct SettingSpace {
  std::vector<int> resolutions = {32, 64, 128, 256};
  std::vector<std::optional<int>> bounces = {0, 1, 2, 3, std::nullopt};  ///< none: auto
  std::vector<Storage> storages = {Storage::unorm8, Storage::float16, Storage::float32};
  std::vector<float> steps = {1.0f, 0.5f};
  std::vector<int> cones = {4, 6, 9, 16, 32, 64};  ///< at the pixels

  size_t size(size_t axis) const;
};

enum SettingAxis : size_t { resolution_axis, bounce_axis, storage_axis, step_axis, cone_axis, setting_axes };

/// A setting of the space: an index per axis.
using SettingPoint = std::array<size_t, setting_axes>;

/// The axes' parameters as Settings name them: "grid.resolution".
std::array<const char*, setting_axes> axis_parameters();
/// Leaves an axis the one value that `settings` have.
void fix(SettingSpace& space, size_t axis, const Settings& settings);

/// Every setting, the last axis fastest.
std::vector<SettingPoint> all_points(const SettingSpace& space);

/// `base` with the point's values.
Settings at(const SettingSpace& space, const SettingPoint& point, Settings base);

/// How tables show a setting: voxels, bounces, storage, step, cones.
std::vector<Column> setting_columns();
std::vector<Cell> setting_cells(const Settings& settings);
/// The same in words: "64 voxels, 2 bounces, unorm8, step 1, 9 cones".
std::string setting_words(const Settings& settings);

}  // namespace voxref
