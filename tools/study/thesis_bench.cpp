#include "study/thesis_bench.h"

#include <algorithm>

#include "study/study_scenes.h"

namespace voxref {

Settings thesis_settings(int resolution) {
  Settings settings = profile("villegas2016");
  settings.grid.resolution = resolution;
  settings.shade.shadow = VoxelShadow::none;
  settings.render.pixel.shadow = PixelShadow::none;
  return settings;
}

PreparedScene::PreparedScene(const StudyScene& scene, const Settings& settings, const Progress& progress)
    : scene_(scene), caster_(scene.scene), progress_(progress) {
  const Grid grid = fit_grid(scene.scene.bounds(), settings.grid);
  fixed = seconds_of([&] { surfaces_ = voxelize_static(scene.scene, grid, settings.voxelize, progress); });
  dynamic =
      seconds_of([&] { surfaces_ = add_dynamic(scene.scene, std::move(surfaces_), settings.voxelize, progress); });
}

LitVoxels PreparedScene::lit(const Settings& settings) const {
  return light_voxels(scene_.scene, caster_, surfaces_, glm::vec3(0.0f), settings, nullptr, progress_);
}

Image PreparedScene::image(const Settings& settings, const LitVoxels& volume, int width) const {
  return gather_image(scene_.scene, caster_, sized(scene_.view, width), settings, volume, progress_).image.image;
}

double PreparedScene::image_seconds(const Settings& settings, const LitVoxels& volume, int width) const {
  const double fixed_part = seconds_of([&] { image(settings, volume, 2); });
  return std::max(0.0, seconds_of([&] { image(settings, volume, width); }) - fixed_part);
}

}  // namespace voxref
