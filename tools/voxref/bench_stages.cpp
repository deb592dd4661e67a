#include "bench_stages.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <glm/geometric.hpp>
#include <random>
#include <utility>

#include "cone/bounce.h"
#include "cone/interpolate_wide.h"
#include "cone/lookup.h"
#include "cone/render.h"
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

template <class Texel>
std::vector<StageBench> bench(const Scene& scene, const Caster& caster, const View& view, const Settings& settings,
                              const Stopwatch& watch) {
  const auto nothing = [] { return 0; };
  const Grid grid = fit_grid(scene.bounds(), settings.grid);
  SurfaceGrid surfaces;
  StageBench voxelized = watch(
      "voxelize", "voxels", [&] { return std::exchange(surfaces, {}).size(); },
      [&](size_t) { surfaces = voxelize(scene, grid, settings.voxelize); });
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

  const LitVolume volume = lit_volume(std::move(bounced.pyramid), settings.render.cone.opacity, settings.mipmap.filter);
  const LitScene from{scene, caster, volume, settings.grid.bounds.value_or(scene.bounds()), settings.light};
  StageBench image = watch("image", "cones", nothing, [&](int) { render_cones(from, view, settings.render); });
  const double specular_and_shadow = 1.0 + (settings.render.pixel.shadow == PixelShadow::cone ? 1.0 : 0.0);
  const double per_pixel = double(pixel_cones(settings.render.cone.diffuse).cones.size()) + specular_and_shadow;
  image.count = per_pixel * view.width * view.height;
  image.bytes = filtered.bytes;
  return {voxelized, shaded, filtered, bounce_bench, image};
}

template <class Kernel>
inline Float4 sum_of_lookups(const Medium& medium, const std::vector<glm::vec4>& samples, const OpticalRead& read) {
  Float4 sum{};
  for (const glm::vec4& sample : samples) sum += quadrilinear<Kernel>(medium, load(sample), sample.w, read);
  return sum;
}
VOXREF_WIDE_ALL Float4 sum_of_wide_lookups(const Medium& medium, const std::vector<glm::vec4>& samples,
                                           const OpticalRead& read) {
  return sum_of_lookups<WideKernel>(medium, samples, read);
}

/// Look-ups at positions and levels that are made before the clock runs.
double lookup_nanoseconds(const Medium& medium, const std::vector<glm::vec4>& samples) {
  const OpticalRead read(glm::normalize(glm::vec3(0.5f, -0.3f, 0.8f)));
  double best = 1e9;
  Float4 sum{};
  for (int round = 0; round < 5; ++round) {
    const double start = processor_seconds();
    sum +=
        wide_machine ? sum_of_wide_lookups(medium, samples, read) : sum_of_lookups<PlainKernel>(medium, samples, read);
    best = std::min(best, processor_seconds() - start);
  }
  // What nobody uses the compiler would leave out.
  return sum[3] < 0.0f ? 0.0 : 1e9 * best / double(samples.size());
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

LookupBench bench_lookup(const Scene& scene, const Settings& settings) {
  const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize);
  const std::vector<glm::vec3> white(surfaces.size(), glm::vec3(1.0f));
  const Medium medium = make_medium(mipmap(surfaces, white, settings.mipmap));
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  constexpr size_t count = size_t{1} << 18;
  const float top = std::min(4.0f, float(medium.top()));
  std::vector<glm::vec4> far, near;
  for (size_t i = 0; i < count; ++i) {
    const glm::ivec3& voxel = surfaces.voxels[random() % surfaces.size()];
    const glm::vec3 inside(uniform(random), uniform(random), uniform(random));
    far.emplace_back(glm::vec3(voxel) + inside, top * uniform(random));
    near.emplace_back(2.0f + 4.0f * inside, uniform(random));
  }
  Grid small;
  small.size = glm::ivec3(8);  // 8 KiB, and 6 KiB of the level above
  BrickVolume<glm::vec4> full(small.size);
  full.allocate(std::vector{glm::ivec3(0)});
  std::ranges::fill(full.texels(), glm::vec4(0.5f));
  return {lookup_nanoseconds(medium, far),
          lookup_nanoseconds(make_medium(mipmap(small, std::move(full), MipmapOptions{})), near)};
}

}  // namespace voxref
