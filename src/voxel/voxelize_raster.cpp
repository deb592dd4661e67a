#include "voxel/voxelize_raster.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <memory>
#include <numeric>
#include <span>
#include <type_traits>
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

  void add(const FragmentValue& fragment) {
    albedo += fragment.albedo;
    normal += fragment.normal;
    emission += fragment.emission;
    ++count;
  }
  bool empty() const { return count == 0; }
};

/// The same in the published shaders' bytes.
struct VoxelAverages {
  RunningAverage8 albedo, normal, emission;

  void add(const FragmentValue& fragment) {
    albedo.add(fragment.albedo);
    normal.add(fragment.normal);
    emission.add(fragment.emission);
  }
  bool empty() const { return albedo.empty(); }
};

/// Slices of voxels that one task averages.
constexpr int slices_per_layer = 4;

/// A fragment of a layer.
struct LayerFragment {
  uint32_t cell;  ///< voxel x + size x (y + size y z), z from the layer's first slice
  const FragmentValue* value;
};

/// Fragments by the layer that they fall in, in draw order within each.
class Layers {
 public:
  /// @param chunks kept by reference
  Layers(const std::vector<VoxelFragments>& chunks, const glm::ivec3& size)
      : begin_(size_t((size.z + slices_per_layer - 1) / slices_per_layer) + 1) {
    std::vector<std::vector<size_t>> next(chunks.size(), std::vector<size_t>(count()));
    parallel_for(chunks.size(), 1, [&](size_t chunk, size_t) {
      for (const VoxelFragments::Fragment& f : chunks[chunk].fragments) ++next[chunk][f.voxel.z / slices_per_layer];
    });
    size_t total = 0;
    for (size_t k = 0; k < count(); ++k) {
      begin_[k] = total;
      for (auto& counts : next) total += std::exchange(counts[k], total);
    }
    begin_.back() = total;
    fragments_.resize(total);
    const auto width = uint32_t(size.x), height = uint32_t(size.y);
    parallel_for(chunks.size(), 1, [&](size_t chunk, size_t) {
      for (const VoxelFragments::Fragment& f : chunks[chunk].fragments)
        fragments_[next[chunk][f.voxel.z / slices_per_layer]++] = {
            f.voxel.x + width * (f.voxel.y + height * (f.voxel.z % slices_per_layer)), &chunks[chunk].values[f.value]};
    });
  }
  size_t count() const { return begin_.size() - 1; }
  std::span<const LayerFragment> operator[](size_t k) const {
    return std::span(fragments_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }

 private:
  std::vector<size_t> begin_;
  std::vector<LayerFragment> fragments_;
};

/// Which voxels of a layer are occupied: cells as LayerFragment has them, so that their order is z, y, x.
class CellSet {
 public:
  explicit CellSet(size_t cells) : bits_((cells + 63) / 64) {}
  void add(uint32_t cell) {
    uint64_t& word = bits_[cell / 64];
    size_ += ~word >> (cell % 64) & 1u;
    word |= uint64_t{1} << (cell % 64);
  }
  size_t size() const { return size_; }
  /// Calls visit(cell) for each, in order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (size_t i = 0; i < bits_.size(); ++i)
      for (uint64_t word = bits_[i]; word != 0; word &= word - 1)
        visit(uint32_t(64 * i) + uint32_t(std::countr_zero(word)));
  }

 private:
  std::vector<uint64_t> bits_;
  size_t size_ = 0;
};

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

void allocate(SurfaceGrid& surfaces, size_t count, VoxelAverage average, bool dynamic, bool emits) {
  surfaces.resize(count, emits);
  if (average == VoxelAverage::area)
    surfaces.area.resize(count);
  else
    surfaces.fragments.resize(count);
  if (dynamic) surfaces.dynamic.resize(count);
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

/// One layer of voxels: what was there before, and the fragments that are added.
class Layer {
 public:
  /// @param before, fragments kept by reference
  Layer(const SurfaceGrid& before, size_t k, std::span<const LayerFragment> fragments)
      : before_(before), fragments_(fragments), first_slice_(int(k) * slices_per_layer), cells_(cell_count()) {
    const auto slice = [&](int z) {
      return std::lower_bound(before.voxels.begin(), before.voxels.end(), glm::ivec3(0, 0, z), voxref::before) -
             before.voxels.begin();
    };
    old_begin_ = size_t(slice(first_slice_)), old_end_ = size_t(slice(first_slice_ + slices_per_layer));
    for (size_t old = old_begin_; old < old_end_; ++old) cells_.add(cell_of(before.voxels[old]));
    for (const LayerFragment& fragment : fragments) cells_.add(fragment.cell);
  }
  size_t voxel_count() const { return cells_.size(); }

  /// Averages the fragments into what the voxels held, and stores them from voxel `first` on.
  template <class Averages>
  void store_averages(const VoxelizeOptions& options, SurfaceGrid& surfaces, size_t first) const {
    // The place of each occupied cell among them. Other places are not read.
    const auto places = std::make_unique_for_overwrite<uint32_t[]>(cell_count());
    std::vector<glm::ivec3> voxels;
    voxels.reserve(voxel_count());
    const auto width = uint32_t(before_.grid.size.x), height = uint32_t(before_.grid.size.y);
    uint32_t row = 0;
    cells_.for_each([&](uint32_t cell) {
      if (cell - row * width >= width) row = cell / width;
      places[cell] = uint32_t(voxels.size());
      voxels.emplace_back(cell - row * width, row % height, first_slice_ + int(row / height));
    });
    std::vector<Averages> averages(voxels.size());
    std::vector<uint8_t> was_there(voxels.size());
    if constexpr (std::is_same_v<Averages, VoxelAverages>)
      for (size_t old = old_begin_; old < old_end_; ++old) {
        const uint32_t place = places[cell_of(before_.voxels[old])];
        was_there[place] = 1;
        averages[place] = restored(before_, old);
      }
    // Most voxels get one fragment, and most fragments have the same value as the one before.
    Averages alone;
    const FragmentValue* alone_of = nullptr;
    for (const LayerFragment& fragment : fragments_) {
      const uint32_t place = places[fragment.cell];
      if (options.static_wins && was_there[place]) continue;
      if (fragment.value != alone_of) {
        alone = {};
        alone.add(*fragment.value);
        alone_of = fragment.value;
      }
      if (averages[place].empty())
        averages[place] = alone;
      else
        averages[place].add(*fragment.value);
    }
    for (size_t i = 0; i < voxels.size(); ++i) {
      surfaces.voxels[first + i] = voxels[i];
      if (!surfaces.dynamic.empty()) surfaces.dynamic[first + i] = !was_there[i];
      surfaces.centroid[first + i] = surfaces.grid.center(voxels[i]);
      store(surfaces, first + i, averages[i]);
    }
  }

 private:
  size_t cell_count() const {
    const glm::ivec3& size = before_.grid.size;
    return size_t(size.x) * size_t(size.y) * slices_per_layer;
  }
  uint32_t cell_of(const glm::ivec3& voxel) const {
    const glm::ivec3& size = before_.grid.size;
    return uint32_t(voxel.x + size.x * (voxel.y + size.y * (voxel.z - first_slice_)));
  }
  const SurfaceGrid& before_;
  std::span<const LayerFragment> fragments_;
  int first_slice_;
  size_t old_begin_ = 0, old_end_ = 0;
  CellSet cells_;
};

}  // namespace

SurfaceGrid voxelize_raster(const Scene& scene, const SurfaceGrid& before, bool dynamic, const VoxelizeOptions& options,
                            const Progress& progress) {
  const Grid& grid = before.grid;
  assert(grid.size.x == grid.size.y && grid.size.x == grid.size.z);
  assert(options.average == VoxelAverage::running_floor8 || before.size() == 0);
  const std::vector<VoxelFragments> drawn = draw_fragments(scene, grid, dynamic, progress);
  const Layers layers(drawn, grid.size);
  std::vector<size_t> first(layers.count() + 1);  // voxel of each layer
  parallel_for(layers.count(), 1, [&](size_t k, size_t) {
    progress.check();
    first[k + 1] = Layer(before, k, layers[k]).voxel_count();
  });
  std::partial_sum(first.begin(), first.end(), first.begin());

  SurfaceGrid surfaces;
  surfaces.grid = grid;
  allocate(surfaces, first.back(), options.average, dynamic, scene.has_emission());
  parallel_for(layers.count(), 1, [&](size_t k, size_t) {
    progress.check();
    const Layer layer(before, k, layers[k]);
    if (options.average == VoxelAverage::area)
      layer.store_averages<PlainMean>(options, surfaces, first[k]);
    else
      layer.store_averages<VoxelAverages>(options, surfaces, first[k]);
  });
  return surfaces;
}

}  // namespace voxref
