#include "study/thesis_bench.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "study/study_scenes.h"
#include "voxel/mipmap.h"

namespace voxref {

namespace {

/// Of the processor, all threads together: what other programs take of it does not count.
template <class Work>
double seconds_of(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

constexpr int two_pixels = 2;  // wide

}  // namespace

Settings thesis_settings(int resolution) {
  Settings settings = profile("villegas2016");
  settings.grid.resolution = resolution;
  settings.shade.shadow = VoxelShadow::none;
  settings.render.pixel.shadow = PixelShadow::none;
  return settings;
}

Settings thesis_shadow_settings(int resolution) {
  Settings settings = thesis_settings(resolution);
  settings.bounce.count = 0;
  return settings;
}

PreparedScene::PreparedScene(const StudyScene& scene, const Settings& settings, const Progress& progress)
    : scene_(scene),
      caster_(scene.scene),
      surfaces_(voxelize(scene.scene, fit_grid(scene.scene.bounds(), settings.grid), settings.voxelize, progress)),
      progress_(progress) {}

LitVoxels PreparedScene::lit(const Settings& settings) const {
  return light_voxels(scene_.scene, caster_, surfaces_, glm::vec3(0.0f), settings, nullptr, progress_);
}

Timing PreparedScene::shading_timing(const Settings& settings) const {
  const auto round = [&] {
    return std::vector<double>{
        seconds_of([&] { shade(scene_.scene, &caster_, surfaces_, settings.light, settings.shade, progress_); })};
  };
  return repeated(round).front();
}

Image PreparedScene::image(const Settings& settings, const LitVoxels& volume, int width) const {
  return gather_image(scene_.scene, caster_, sized(scene_.view, width), settings, volume, progress_).image.image;
}

Timing PreparedScene::image_timing(const Settings& settings, const LitVoxels& volume, int width) const {
  const auto round = [&] {
    const double fixed = seconds_of([&] { image(settings, volume, two_pixels); });
    return std::vector<double>{std::max(0.0, seconds_of([&] { image(settings, volume, width); }) - fixed)};
  };
  return repeated(round).front();
}

StageTimings measure_stages(const StudyScene& scene, int resolution, int width, const Progress& progress) {
  const Settings settings = thesis_settings(resolution);
  const Grid grid = fit_grid(scene.scene.bounds(), settings.grid);
  const Caster caster(scene.scene);
  StageTimings result;
  const auto round = [&] {
    progress.check();
    SurfaceGrid fixed, frame;
    const double fixed_seconds =
        seconds_of([&] { fixed = voxelize_static(scene.scene, grid, settings.voxelize, progress); });
    const double clear = seconds_of([&] { frame = fixed; });
    const double dynamic =
        seconds_of([&] { frame = add_dynamic(scene.scene, std::move(frame), settings.voxelize, progress); });
    Shading shading;
    Clamping clamped;
    const double shade_seconds = seconds_of([&] {
      shading = shade(scene.scene, &caster, frame, settings.light, settings.shade, progress);
      for (glm::vec3& radiance : shading.radiance) radiance = clamped.store<Rgba8>(radiance);
    });
    Pyramid8 pyramid;
    const auto filter = [&] { pyramid = mipmap<Rgba8>(frame, shading.radiance, settings.mipmap, progress); };
    const double first_mipmap = seconds_of(filter), second_mipmap = seconds_of(filter);
    const double both = seconds_of([&] {
      pyramid = bounce(frame, shading.radiance, std::move(pyramid), settings.bounce, settings.render.cone,
                       settings.mipmap, glm::vec3(0.0f), progress)
                    .pyramid;
    });
    result.bytes = predict_bytes(frame, settings).at("total");
    LitVoxels lit;
    lit.grid = grid;
    lit.volume = lit_volume(std::move(pyramid), settings.render.cone.opacity, settings.mipmap.filter);
    const auto image = [&](int pixels) {
      return seconds_of([&] { gather_image(scene.scene, caster, sized(scene.view, pixels), settings, lit, progress); });
    };
    const double fixed_part = image(two_pixels), cones = std::max(0.0, image(width) - fixed_part);
    const double bounce_alone = std::max(0.0, both - second_mipmap);
    std::vector<double> seconds = {fixed_seconds, clear,        dynamic,       shade_seconds,
                                   first_mipmap,  bounce_alone, second_mipmap, cones};
    double total = 0.0;
    for (size_t i = 1; i < seconds.size(); ++i) total += seconds[i];
    seconds.push_back(total);
    return seconds;
  };
  const std::vector<Timing> t = repeated(round);
  result.fixed = t[0];
  result.clear = t[1];
  result.dynamic = t[2];
  result.shade = t[3];
  result.mipmap = t[4];
  result.bounce = t[5];
  result.bounce_mipmap = t[6];
  result.cones = t[7];
  result.total = t[8];
  return result;
}

size_t volume_memory(const StudyScene& scene, int resolution, const Progress& progress) {
  const Settings settings = thesis_settings(resolution);
  return predict_bytes(
             voxelize(scene.scene, fit_grid(scene.scene.bounds(), settings.grid), settings.voxelize, progress),
             settings)
      .at("total");
}

}  // namespace voxref
