#include "voxel/voxelize_raster.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "parallel.h"
#include "voxel/raster_fragments.h"
#include "voxel/running_average.h"
#include "voxel/texel.h"

namespace voxref {

namespace {

/// What a voxel holds while fragments are averaged into it: the plain mean, in which each pixel counts as one face.
struct PlainMean {
  glm::dvec3 albedo{0.0}, normal{0.0}, emission{0.0};  ///< sums
  uint32_t count = 0;

  void add(const VoxelFragment& fragment) {
    albedo += fragment.albedo;
    normal += fragment.normal;
    emission += fragment.emission;
    ++count;
  }
};

/// The same in the published shaders' bytes.
struct VoxelAverages {
  RunningAverage8 albedo, normal, emission;

  void add(const VoxelFragment& fragment) {
    albedo.add(fragment.albedo);
    normal.add(fragment.normal);
    emission.add(fragment.emission);
  }
};

/// Slices of voxels that one task averages.
constexpr int slices_per_layer = 4;

struct KeyedFragment {
  uint32_t row;  ///< y + size z, in the layer
  int x;
  const VoxelFragment* fragment;
};

/// Fragments by the layer that they fall in, in draw order within each.
class Layers {
 public:
  Layers(const std::vector<std::vector<VoxelFragment>>& chunks, const glm::ivec3& size)
      : begin_(size_t((size.z + slices_per_layer - 1) / slices_per_layer) + 1) {
    std::vector<std::vector<size_t>> next(chunks.size(), std::vector<size_t>(count()));
    parallel_for(chunks.size(), 1, [&](size_t chunk, size_t) {
      for (const VoxelFragment& f : chunks[chunk]) ++next[chunk][size_t(f.voxel.z / slices_per_layer)];
    });
    size_t total = 0;
    for (size_t k = 0; k < count(); ++k) {
      begin_[k] = total;
      for (auto& counts : next) total += std::exchange(counts[k], total);
    }
    begin_.back() = total;
    fragments_.resize(total);
    parallel_for(chunks.size(), 1, [&](size_t chunk, size_t) {
      for (const VoxelFragment& f : chunks[chunk])
        fragments_[next[chunk][size_t(f.voxel.z / slices_per_layer)]++] = {
            uint32_t(f.voxel.y + size.y * (f.voxel.z % slices_per_layer)), f.voxel.x, &f};
    });
  }
  size_t count() const { return begin_.size() - 1; }
  std::span<KeyedFragment> operator[](size_t k) {
    return std::span(fragments_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }

 private:
  std::vector<size_t> begin_;
  std::vector<KeyedFragment> fragments_;
};

/// Sorts by a key below `keys`, keeping the order of equals (counting sort).
template <class Key>
void sort_stably(std::span<const KeyedFragment> from, std::span<KeyedFragment> to, size_t keys, Key&& key) {
  std::vector<uint32_t> next(keys + 1);
  for (const KeyedFragment& f : from) ++next[size_t(key(f)) + 1];
  for (size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  for (const KeyedFragment& f : from) to[next[size_t(key(f))]++] = f;
}

/// Sorts a layer's fragments by voxel z, y, x, those of one voxel in draw order.
void sort_by_voxel(std::span<KeyedFragment> fragments, const glm::ivec3& size) {
  std::vector<KeyedFragment> by_x(fragments.size());
  sort_stably(fragments, by_x, size_t(size.x), [](const KeyedFragment& f) { return f.x; });
  sort_stably(by_x, fragments, size_t(size.y * slices_per_layer), [](const KeyedFragment& f) { return f.row; });
}

constexpr float byte_step = 1.0f / 255.0f;

glm::vec3 decoded(const RunningAverage8& average) {
  return byte_step * glm::vec3(average.value[0], average.value[1], average.value[2]);
}

/// The bytes of a voxel that was averaged before.
RunningAverage8 restored(const glm::vec3& value, uint8_t count) {
  const Rgba8 bytes = encode<Rgba8>(load(glm::vec4(value, 0.0f)));
  return {{bytes.bytes[0], bytes.bytes[1], bytes.bytes[2]}, count};
}

VoxelAverages restored(const SurfaceGrid& surfaces, size_t i) {
  const uint8_t count = surfaces.fragments[i];
  return {restored(glm::vec3(surfaces.albedo[i]), count), restored(0.5f * surfaces.normal[i] + 0.5f, count),
          restored(surfaces.emission.empty() ? glm::vec3(0.0f) : surfaces.emission[i], count)};
}

bool earlier(const glm::ivec3& a, const glm::ivec3& b) { return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x); }

constexpr size_t none = ~size_t{0};

/// Merges what was there before with a layer's fragments, which are sorted by voxel. Calls visit(voxel, index in
/// `before` or none, its fragments) for each voxel that has either, sorted z, y, x.
template <class Visit>
void for_each_voxel(const SurfaceGrid& before, size_t layer, std::span<const KeyedFragment> fragments, Visit&& visit) {
  const auto slice = [](size_t k) { return glm::ivec3(0, 0, int(k) * slices_per_layer); };
  const auto first = std::lower_bound(before.voxels.begin(), before.voxels.end(), slice(layer), earlier);
  size_t old = size_t(first - before.voxels.begin());
  const auto visit_old_until = [&](const glm::ivec3& voxel) {
    for (; old < before.size() && earlier(before.voxels[old], voxel); ++old)
      visit(before.voxels[old], old, fragments.subspan(0, 0));
  };
  for (size_t i = 0; i < fragments.size();) {
    size_t end = i + 1;
    while (end < fragments.size() && fragments[end].row == fragments[i].row && fragments[end].x == fragments[i].x)
      ++end;
    const glm::ivec3& voxel = fragments[i].fragment->voxel;
    visit_old_until(voxel);
    const bool was_there = old < before.size() && before.voxels[old] == voxel;
    visit(voxel, was_there ? old++ : none, fragments.subspan(i, end - i));
    i = end;
  }
  visit_old_until(slice(layer + 1));
}

void allocate(SurfaceGrid& surfaces, size_t count, VoxelAverage average, bool dynamic, bool emits) {
  surfaces.voxels.resize(count);
  if (average == VoxelAverage::area)
    surfaces.area.resize(count);
  else
    surfaces.fragments.resize(count);
  if (dynamic) surfaces.dynamic.resize(count);
  surfaces.albedo.resize(count);
  surfaces.normal.resize(count);
  surfaces.centroid.resize(count);
  if (emits) surfaces.emission.resize(count);
}

void store(SurfaceGrid& surfaces, size_t i, const VoxelAverages& averages) {
  surfaces.fragments[i] = averages.albedo.count;
  surfaces.albedo[i] = glm::vec4(decoded(averages.albedo), averages.albedo.empty() ? 0.0f : 1.0f);
  surfaces.normal[i] = 2.0f * decoded(averages.normal) - 1.0f;
  if (!surfaces.emission.empty()) surfaces.emission[i] = decoded(averages.emission);
}

void store(SurfaceGrid& surfaces, size_t i, const PlainMean& sums) {
  const double count = sums.count;
  surfaces.area[i] = surfaces.grid.voxel * surfaces.grid.voxel * float(count);
  surfaces.albedo[i] = glm::vec4(sums.albedo / count, 1.0f);
  surfaces.normal[i] = glm::vec3(2.0 * sums.normal / count - 1.0);
  if (!surfaces.emission.empty()) surfaces.emission[i] = glm::vec3(sums.emission / count);
}

/// Averages a voxel's fragments into what it held, and stores it as voxel i.
void average(SurfaceGrid& surfaces, size_t i, const SurfaceGrid& before, size_t old,
             std::span<const KeyedFragment> fragments, const VoxelizeOptions& options) {
  const auto add_all = [&](auto averages) {
    for (const KeyedFragment& keyed : fragments) averages.add(*keyed.fragment);
    store(surfaces, i, averages);
  };
  if (options.average == VoxelAverage::area)
    add_all(PlainMean{});
  else if (old == none)
    add_all(VoxelAverages{});
  else if (options.static_wins)
    store(surfaces, i, restored(before, old));
  else
    add_all(restored(before, old));
}

}  // namespace

SurfaceGrid voxelize_raster(const Scene& scene, const SurfaceGrid& before, bool dynamic, const VoxelizeOptions& options,
                            const Progress& progress) {
  const Grid& grid = before.grid;
  assert(grid.size.x == grid.size.y && grid.size.x == grid.size.z);
  assert(options.average == VoxelAverage::running_floor8 || before.size() == 0);
  const std::vector<std::vector<VoxelFragment>> drawn = draw_fragments(scene, grid, dynamic, progress);
  Layers layers(drawn, grid.size);
  std::vector<size_t> first(layers.count() + 1);  // voxel of each layer
  parallel_for(layers.count(), 1, [&](size_t k, size_t) {
    progress.check();
    sort_by_voxel(layers[k], grid.size);
    for_each_voxel(before, k, layers[k], [&](const glm::ivec3&, size_t, auto) { ++first[k + 1]; });
  });
  std::partial_sum(first.begin(), first.end(), first.begin());

  SurfaceGrid surfaces;
  surfaces.grid = grid;
  allocate(surfaces, first.back(), options.average, dynamic, scene.has_emission());
  parallel_for(layers.count(), 1, [&](size_t k, size_t) {
    progress.check();
    size_t i = first[k];
    for_each_voxel(before, k, layers[k], [&](const glm::ivec3& voxel, size_t old, auto fragments) {
      surfaces.voxels[i] = voxel;
      if (dynamic) surfaces.dynamic[i] = old == none;
      surfaces.centroid[i] = grid.center(voxel);
      average(surfaces, i++, before, old, fragments, options);
    });
  });
  return surfaces;
}

}  // namespace voxref
