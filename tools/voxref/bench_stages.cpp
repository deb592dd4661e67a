#include "bench_stages.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <utility>

#include "cone/bounce.h"
#include "cone/render.h"
#include "error.h"
#include "parallel.h"
#include "voxel/shade.h"

namespace voxref {
namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Runs stages and keeps their times.
class Stopwatch {
 public:
  Stopwatch(int rounds, bool processor_time, const Progress& progress)
      : rounds_(rounds), now_(processor_time ? processor_seconds : wall_seconds), progress_(progress) {}

  /// @param run once per round; `prepare` before it is not measured
  template <class Prepare, class Run>
  StageBench operator()(const char* stage, const char* unit, Prepare&& prepare, Run&& run) const {
    StageBench bench{stage, unit, 0.0, 0.0, {}};
    for (int round = 0; round < rounds_; ++round) {
      progress_.check();
      auto input = prepare();
      const double start = now_();
      run(std::move(input));
      bench.seconds.push_back(now_() - start);
    }
    return bench;
  }

 private:
  int rounds_;
  double (*now_)();
  const Progress& progress_;
};

template <class Texel>
double texels_of(const BasicPyramid<Texel>& pyramid) {
  size_t texels = 0;
  for (const auto& level : pyramid.levels) texels += 6 * level.texels().size();
  return double(texels);
}

/// Cones that a point seen in the image casts: those of the lobes that it has, and to the lights before it.
size_t cones_of(const GBufferPoint& point, const Scene& scene, const Settings& settings, size_t diffuse) {
  const PixelOptions& pixel = settings.render.pixel;
  const bool phong = pixel.brdf == PixelBrdf::blinn_phong;
  const bool matt = phong ? point.phong.diffuse != glm::vec3(0.0f) : point.reflectance.has_diffuse();
  const bool glossy = phong ? point.phong.specular != glm::vec3(0.0f) : point.reflectance.has_specular();
  size_t cones = (matt ? diffuse : 0) + (glossy ? 1 : 0);
  if (pixel.shadow != PixelShadow::cone) return cones;
  for (const Light& light : scene.lights) {
    const Illumination lit = illuminate(light, point.position, settings.light);
    cones += lit.attenuation != 0.0f && glm::dot(point.normal, lit.to_light) > 0.0f;
  }
  return cones;
}

/// Of all pixels that see something, as render_cones samples them.
double cones_of_image(const Scene& scene, const Caster& caster, const View& view, const Settings& settings) {
  const GBuffer gbuffer(scene, caster, view, settings.render.gbuffer);
  const size_t diffuse = pixel_cones(settings.render.cone.diffuse).cones.size();
  const int side = positions_per_side(view.pixel);
  std::vector<size_t> rows(size_t(view.height));
  parallel_for(rows.size(), 1, [&](size_t y, size_t) {
    for (int i = 0; i < view.width * side * side; ++i) {
      const int x = i / (side * side), at = i % (side * side);
      const glm::vec2 offset = (glm::vec2(at % side, at / side) + 0.5f) / float(side);
      if (const auto point = gbuffer(glm::vec2(x, y) + offset)) rows[y] += cones_of(*point, scene, settings, diffuse);
    }
  });
  return double(std::accumulate(rows.begin(), rows.end(), size_t{0}));
}

template <class Texel>
std::vector<StageBench> bench(const Scene& scene, const Caster& caster, const View& view, const Settings& settings,
                              const Stopwatch& watch) {
  const auto nothing = [] { return 0; };
  const Grid grid = fit_grid(scene.bounds(), settings.grid);
  SurfaceGrid surfaces;
  StageBench voxelized = watch(
      "voxelize", "voxels", [&] { return std::exchange(surfaces, {}).size(); },
      [&](size_t) { surfaces = voxelize(scene, grid, settings.voxelize); });
  if (surfaces.size() == 0) throw Error("SCENE", "occupies no voxel, so that there is nothing to measure");
  voxelized.count = double(surfaces.size());
  voxelized.bytes = double(surfaces.bytes());

  Shading shading;
  StageBench shaded = watch("shade", "voxels", nothing,
                            [&](int) { shading = shade(scene, &caster, surfaces, settings.light, settings.shade); });
  const double lit = double(surfaces.size() * (sizeof(glm::vec3) + sizeof(float)));
  shaded.count = voxelized.count;
  shaded.bytes = voxelized.bytes + lit;
  Clamping ignored;  // the cone command reports it
  for (glm::vec3& radiance : shading.radiance) radiance = ignored.store<Texel>(radiance);

  BasicPyramid<Texel> pyramid;
  StageBench filtered = watch(
      "mipmap", "texels", [&] { return std::exchange(pyramid, {}).levels.size(); },
      [&](size_t) { pyramid = mipmap<Texel>(surfaces, shading.radiance, settings.mipmap); });
  filtered.count = texels_of(pyramid);
  filtered.bytes = double(pyramid.bytes());

  BounceOptions once = settings.bounce;
  once.count = 1;
  BasicBounceResult<Texel> bounced;
  StageBench bounce_bench = watch(
      "bounce", "cones", [&] { return pyramid; },
      [&](BasicPyramid<Texel>&& input) {
        bounced = bounce(surfaces, shading.radiance, std::move(input), once, settings.render.cone, settings.mipmap,
                         view.background);
      });
  bounce_bench.count = voxelized.count * double(voxel_cones(once.cones).cones.size());
  bounce_bench.bytes = voxelized.bytes + lit + 2.0 * filtered.bytes;

  LitVolume volume;
  std::optional<LightVisibility> visibility;
  StageBench prepared = watch(
      "prepare", "texels", [&] { return bounced.pyramid; },
      [&](BasicPyramid<Texel>&& input) {
        volume = lit_volume(std::move(input), settings.render.cone.opacity, settings.mipmap.filter);
        if (settings.render.pixel.shadow == PixelShadow::visibility) visibility.emplace(surfaces, shading.visibility);
      });
  prepared.count = filtered.count;
  prepared.bytes = filtered.bytes;

  const LitScene from{scene,          caster,
                      volume,         settings.grid.bounds.value_or(scene.bounds()),
                      settings.light, visibility ? &*visibility : nullptr};
  StageBench image = watch("image", "cones", nothing, [&](int) { render_cones(from, view, settings.render); });
  image.count = cones_of_image(scene, caster, view, settings);
  image.bytes = filtered.bytes;
  return {voxelized, shaded, filtered, bounce_bench, prepared, image};
}

}  // namespace

std::vector<StageBench> bench_stages(const Scene& scene, const Caster& caster, const View& view,
                                     const Settings& settings, int rounds, bool processor_time,
                                     const Progress& progress) {
  const Stopwatch watch(rounds, processor_time, progress);
  return with_texel(settings.storage, [&]<class Texel>(std::type_identity<Texel>) {
    return bench<Texel>(scene, caster, view, settings, watch);
  });
}

double triad_bandwidth() {
  constexpr size_t count = size_t{1} << 24;  // 64 MiB each
  std::vector<float> a(count), b(count, 1.0f), c(count, 2.0f);
  double best = 0.0;
  for (int run = 0; run < 5; ++run) {
    const double start = wall_seconds();
    parallel_for(count, count / 64, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) a[i] = b[i] + 3.0f * c[i];
    });
    best = std::max(best, 3.0 * count * sizeof(float) / (wall_seconds() - start));
  }
  return best;
}

}  // namespace voxref
