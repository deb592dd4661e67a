#include "bench_lookups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <glm/geometric.hpp>
#include <random>
#include <utility>

#include "cone/interpolate_wide.h"
#include "cone/lookup.h"
#include "cone/raw_lookup.h"
#include "error.h"

namespace voxref {
namespace {

const glm::vec3 direction = glm::normalize(glm::vec3(0.5f, -0.3f, 0.8f));  // no axis alike
constexpr size_t lanes = TexelLanes::lanes;

/// Where look-ups are made: positions in voxels, and levels.
using Places = std::vector<glm::vec4>;

/// Through extinction, one by one.
class MediumLookups {
 public:
  MediumLookups(const Medium& medium, Places places, bool between_levels)
      : medium_(medium), places_(std::move(places)), between_levels_(between_levels) {}

  template <class Kernel>
  Float4 sum() const {
    const OpticalRead read(direction);
    Float4 total{};
    for (const glm::vec4& place : places_)
      total += between_levels_ ? quadrilinear<Kernel>(medium_, voxref::load(place), place.w, read)
                               : trilinear<Kernel>(medium_, voxref::load(place), static_cast<int>(place.w), read);
    return total;
  }

 private:
  const Medium& medium_;
  Places places_;
  bool between_levels_;
};

/// Of opacity as it is stored, eight side by side.
class RawLookups {
 public:
  RawLookups(const Pyramid8& pyramid, const Places& places, bool between_levels) : pyramid_(pyramid) {
    for (const glm::vec4& place : places) {
      const int level = static_cast<int>(place.w);
      ConeStep step;
      step.level = level;
      step.fraction = between_levels ? place.w - float(level) : 0.0f;
      if (steps_.size() % lanes == 0) groups_.emplace_back();
      Group& group = groups_.back();
      const size_t lane = steps_.size() % lanes;
      group.x[lane] = place.x, group.y[lane] = place.y, group.z[lane] = place.z;
      group.coarsest[lane] = step.coarsest();
      group.coarser_share[lane] = step.coarser_share();
      steps_.push_back(step);
    }
  }

  template <class Kernel>
  Float4 sum() const {
    const SquaredRead read(direction);
    const Int4 last = to_int4(pyramid_.base.size()) - 1;
    Float4 total{};
    const ConeStep* step = steps_.data();
    for (const Group& group : groups_) {
      Float8 x, y, z, coarser_share;
      Int8 coarsest;
      load(group.x, x), load(group.y, y), load(group.z, z);
      load(group.coarsest, coarsest), load(group.coarser_share, coarser_share);
      const RawSamples samples(last, coarsest, coarser_share, x, y, z);
      for (size_t lane = 0; lane < lanes; ++lane) total += sample_raw<Kernel>(pyramid_, samples, lane, *step++, read);
    }
    return total;
  }

 private:
  struct Group {
    std::array<float, lanes> x{}, y{}, z{}, coarser_share{};
    std::array<int32_t, lanes> coarsest{};
  };
  template <class Vector, class Values>
  static void load(const Values& values, Vector& vector) {
    std::memcpy(&vector, values.data(), sizeof vector);
  }

  const Pyramid8& pyramid_;
  std::vector<Group> groups_;
  std::vector<ConeStep> steps_;
};

template <class Lookups>
VOXREF_WIDE_ALL Float4 wide_sum(const Lookups& lookups) {
  return lookups.template sum<WideKernel>();
}

/// Nanoseconds of one, the best of several rounds.
template <class Lookups>
double nanoseconds(const Lookups& lookups, size_t count) {
  double best = 1e9;
  Float4 sum{};
  for (int round = 0; round < 5; ++round) {
    const std::clock_t start = std::clock();
    sum += wide_machine ? wide_sum(lookups) : lookups.template sum<PlainKernel>();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  // What nobody uses the compiler would leave out.
  return sum[3] < 0.0f ? 0.0 : 1e9 * best / double(count);
}

/// At random in the occupied voxels and in levels 0 to 4.
Places places_in(const SurfaceGrid& surfaces, size_t count, float top) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Places places;
  for (size_t i = 0; i < count; ++i) {
    const glm::ivec3& voxel = surfaces.voxels[random() % surfaces.size()];
    const glm::vec3 inside(uniform(random), uniform(random), uniform(random));
    places.emplace_back(glm::vec3(voxel) + inside, std::min(4.0f, top) * uniform(random));
  }
  return places;
}
/// In the middle of a volume of 8^3 voxels and in levels 0 and 1.
Places places_in_cache(size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Places places;
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 inside(uniform(random), uniform(random), uniform(random));
    places.emplace_back(2.0f + 4.0f * inside, uniform(random));
  }
  return places;
}

/// 8^3 voxels: at most 8 KiB, and 6 KiB of the level above.
template <class Texel>
BasicPyramid<Texel> cached_pyramid() {
  Grid grid;
  grid.size = glm::ivec3(8);
  BrickVolume<Texel> full(grid.size);
  full.allocate(std::vector{glm::ivec3(0)});
  std::ranges::fill(full.texels(), encode<Texel>(Float4{0.5f, 0.5f, 0.5f, 0.5f}));
  return mipmap(grid, std::move(full), MipmapOptions{});
}

}  // namespace

std::vector<LookupBench> bench_lookups(const Scene& scene, const Settings& settings) {
  const SurfaceGrid surfaces = voxelize(scene, fit_grid(scene.bounds(), settings.grid), settings.voxelize);
  if (surfaces.size() == 0) throw Error("SCENE", "occupies no voxel, so that there is nothing to look up");
  const std::vector<glm::vec3> white(surfaces.size(), glm::vec3(1.0f));
  constexpr size_t count = size_t{1} << 18;
  const Places near = places_in_cache(count);
  std::vector<LookupBench> lookups;
  const auto both = [&](const std::string& name, const auto& measure) {
    for (const bool between_levels : {false, true})
      lookups.push_back(measure(name + (between_levels ? ", quadrilinear" : ", trilinear"), between_levels));
  };
  {
    const Medium medium = make_medium(mipmap(surfaces, white, settings.mipmap), settings.mipmap.filter);
    const Medium cached = make_medium(cached_pyramid<glm::vec4>());
    const Places far = places_in(surfaces, count, float(medium.top()));
    both("extinction, float32", [&](const std::string& kind, bool between_levels) {
      return LookupBench{kind, nanoseconds(MediumLookups(medium, far, between_levels), count),
                         nanoseconds(MediumLookups(cached, near, between_levels), count)};
    });
  }
  const Pyramid8 pyramid = mipmap<Rgba8>(surfaces, white, settings.mipmap), cached = cached_pyramid<Rgba8>();
  const Places far = places_in(surfaces, count, float(pyramid.levels.size()));
  both("raw, unorm8", [&](const std::string& kind, bool between_levels) {
    return LookupBench{kind, nanoseconds(RawLookups(pyramid, far, between_levels), count),
                       nanoseconds(RawLookups(cached, near, between_levels), count)};
  });
  return lookups;
}

void say(Terminal& terminal, const std::vector<LookupBench>& lookups) {
  for (const LookupBench& l : lookups)
    terminal.say(fmt::format("  look-up, {:<36} {:>6.1f} ns, in the first cache {:.1f} ns, one thread", l.kind,
                             l.volume, l.bare));
}

nlohmann::json to_json(const std::vector<LookupBench>& lookups) {
  nlohmann::json list = nlohmann::json::array();
  for (const LookupBench& l : lookups)
    list.push_back({{"kind", l.kind}, {"nanoseconds", l.volume}, {"nanoseconds_in_cache", l.bare}});
  return list;
}

}  // namespace voxref
