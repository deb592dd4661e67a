#include "study/thesis_bench.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "study/study_scenes.h"
#include "voxel/mipmap.h"

namespace voxref {

namespace {

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
    // The published storage. What the texels hold does not change the time.
    const std::vector<glm::vec3> grey(frame.size(), glm::vec3(0.5f));
    const double mipmap_again = seconds_of([&] { mipmap<Rgba8>(frame, grey, settings.mipmap, progress); });
    const LitVoxels lit =
        light_voxels(scene.scene, caster, std::move(frame), glm::vec3(0.0f), settings, nullptr, progress);
    result.bytes = lit.bytes.at("total");
    const auto image = [&](int pixels) {
      return seconds_of([&] { gather_image(scene.scene, caster, sized(scene.view, pixels), settings, lit, progress); });
    };
    const double fixed_part = image(two_pixels), cones = std::max(0.0, image(width) - fixed_part);
    const double bounce = std::max(0.0, lit.seconds.bounce - mipmap_again);
    std::vector<double> seconds = {fixed_seconds,      clear,  dynamic,      lit.seconds.shade,
                                   lit.seconds.mipmap, bounce, mipmap_again, cones};
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
