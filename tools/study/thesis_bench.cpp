#include "study/thesis_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numeric>
#include <utility>

#include "error.h"
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

constexpr int fixed_part_width = 2;  ///< pixels: of an image whose time is that of what does not go with pixels
constexpr double published_pixels = 1280.0 * 720.0;

double pixel_count(const View& view) { return double(view.width) * double(view.height); }

}  // namespace

View timed_view(View view, int width) {
  const double pixels = 9.0 / 16.0 * double(width) * double(width);
  view.height = std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / double(view.camera.aspect)))));
  view.width = std::max(1, static_cast<int>(std::lround(pixels / view.height)));
  return view;
}

Image finite_image(ConeTraceResult result, const std::string& scene) {
  if (result.image.nonfinite > 0)
    throw Error(scene, result.image.first_nonfinite,
                fmt::format("the first of {} pixels that are not finite", result.image.nonfinite));
  return std::move(result.image.image);
}

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
  return finite_image(gather_image(scene_.scene, caster_, sized(scene_.view, width), settings, volume, progress_),
                      scene_.name);
}

Timing PreparedScene::image_timing(const Settings& settings, const LitVoxels& volume, int width) const {
  const auto seconds = [&](const View& view) {
    return seconds_of([&] { gather_image(scene_.scene, caster_, view, settings, volume, progress_); });
  };
  const auto round = [&] {
    const double fixed = seconds(sized(scene_.view, fixed_part_width));
    return std::vector<double>{std::max(0.0, seconds(timed_view(scene_.view, width)) - fixed)};
  };
  return repeated(round).front();
}

namespace {

/// In the order of a round's seconds.
constexpr std::array stages = {&StageTimings::fixed,         &StageTimings::clear,  &StageTimings::dynamic,
                               &StageTimings::shade,         &StageTimings::mipmap, &StageTimings::bounce,
                               &StageTimings::bounce_mipmap, &StageTimings::cones,  &StageTimings::total};

/// Scaled to the published number of pixels.
double cones_seconds(const StudyScene& scene, const Caster& caster, const Settings& settings, const LitVoxels& lit,
                     int width, const Progress& progress) {
  const auto seconds = [&](const View& view) {
    return seconds_of([&] { gather_image(scene.scene, caster, view, settings, lit, progress); });
  };
  const View view = timed_view(scene.view, width);
  const double fixed = seconds(sized(scene.view, fixed_part_width));
  return std::max(0.0, seconds(view) - fixed) * published_pixels / pixel_count(view);
}

/// Seconds of every stage once. @param result whose bytes and voxels are filled in
std::vector<double> stages_once(const StudyScene& scene, const Caster& caster, const Settings& settings, int width,
                                const Progress& progress, StageTimings& result) {
  progress.check();
  LitVoxels lit;
  lit.grid = fit_grid(scene.scene.bounds(), settings.grid);
  SurfaceGrid fixed, frame;
  const double fixed_seconds =
      seconds_of([&] { fixed = voxelize_static(scene.scene, lit.grid, settings.voxelize, progress); });
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
  result.voxels = frame.size();
  lit.volume = lit_volume(std::move(pyramid), settings.render.cone.opacity, settings.mipmap.filter);
  const double cones = cones_seconds(scene, caster, settings, lit, width, progress);
  std::vector<double> seconds = {fixed_seconds, clear,        dynamic,
                                 shade_seconds, first_mipmap, std::max(0.0, both - second_mipmap),
                                 second_mipmap, cones};
  seconds.push_back(std::accumulate(seconds.begin() + 1, seconds.end(), 0.0));  // static voxels are made once
  return seconds;
}

}  // namespace

StageTimings measure_stages(const StudyScene& scene, int resolution, int width, const Progress& progress) {
  const Settings settings = thesis_settings(resolution);
  const Caster caster(scene.scene);
  StageTimings result;
  const std::vector<Timing> timings =
      repeated([&] { return stages_once(scene, caster, settings, width, progress, result); });
  for (size_t i = 0; i < stages.size(); ++i) result.*stages[i] = timings.at(i);
  return result;
}

}  // namespace voxref
