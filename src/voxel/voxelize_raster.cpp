#include "voxel/voxelize_raster.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "parallel.h"
#include "voxel/brick_volume.h"
#include "voxel/raster.h"
#include "voxel/running_average.h"
#include "voxel/texel.h"

namespace voxref {

namespace {

using Bricks = BrickVolume<float>;  // for its brick layout alone

/// What a voxel holds while fragments are averaged into it.
struct VoxelAverages {
  RunningAverage8 albedo, normal, emission;
  bool written = false;  ///< ever; the count alone wraps to 0
  bool fixed = false;    ///< was there before
};

/// A fragment that is written to a voxel of the grid.
struct Fragment {
  glm::ivec3 voxel;
  glm::vec3 albedo, normal, emission;
};

/// Rows of one triangle's pixels: large triangles are cut, so that several threads can draw them.
struct Rows {
  uint32_t triangle;
  int begin, end;
};
constexpr int rows_per_task = 16;
constexpr size_t tasks_per_chunk = 32;  // small triangles are a task each

/// Texture, factors and the rest of what the published fragment shader does.
class FragmentShader {
 public:
  FragmentShader(const Scene& scene, const Grid& grid) : scene_(scene), grid_(grid) {
    for (const Material& material : scene.materials) {
      bindings_.push_back(material.base_color_texture);
      bindings_.back().srgb = false;
    }
  }

  RasterTriangle triangle(uint32_t index) const {
    RasterTriangle result;
    const auto& uv = scene_.uv[size_t(bindings_[scene_.triangle_materials[index]].uv_set)];
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t vertex = scene_.triangles[index][int(i)];
      result.positions[i] = scene_.positions[vertex];
      result.normals[i] = scene_.normals[vertex];
      result.uv[i] = uv.empty() ? glm::vec2(0.0f) : uv[vertex];
    }
    return result;
  }

  /// Adds what the pixel writes, if anything.
  void operator()(uint32_t triangle, const RasterFragment& pixel, std::vector<Fragment>& written) const {
    if (!grid_.contains(pixel.voxel)) return;
    const uint32_t index = scene_.triangle_materials[triangle];
    const Material& material = scene_.materials[index];
    const TextureBinding& binding = bindings_[index];
    const glm::vec4 texel = binding ? lookup(scene_.images[size_t(binding.image)], binding, pixel.uv) : glm::vec4(1.0f);
    const float opacity = material.base_color.a * texel.a;
    if (!(opacity > 0.0f)) return;
    const glm::vec3 color(texel);
    written.push_back({pixel.voxel, glm::vec3(material.base_color) * color * opacity,
                       0.5f * glm::normalize(pixel.normal) + 0.5f, material.emission * color});
  }

 private:
  const Scene& scene_;
  const Grid& grid_;
  std::vector<TextureBinding> bindings_;  // of the base colour, one per material
};

/// The pixels of all static or all dynamic triangles, in draw order, cut into chunks.
std::vector<std::vector<Fragment>> draw(const Scene& scene, const Grid& grid, bool dynamic, const Progress& progress) {
  const RasterViews views(grid);
  const FragmentShader shader(scene, grid);
  std::vector<Rows> tasks;
  for (const Object& object : scene.objects)
    if (object.dynamic == dynamic)
      for (uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t)
        if (const auto triangle = DilatedTriangle::make(shader.triangle(t), views))
          for (int row = triangle->rows()[0]; row < triangle->rows()[1]; row += rows_per_task)
            tasks.push_back({t, row, std::min(row + rows_per_task, triangle->rows()[1])});

  std::vector<std::vector<Fragment>> chunks((tasks.size() + tasks_per_chunk - 1) / tasks_per_chunk);
  std::atomic<size_t> done = 0;
  parallel_for(tasks.size(), tasks_per_chunk, [&](size_t begin, size_t end) {
    progress.check();
    std::vector<Fragment>& written = chunks[begin / tasks_per_chunk];
    for (size_t i = begin; i < end; ++i) {
      const Rows& rows = tasks[i];
      const auto triangle = DilatedTriangle::make(shader.triangle(rows.triangle), views);
      triangle->for_each_fragment(rows.begin, rows.end,
                                  [&](const RasterFragment& pixel) { shader(rows.triangle, pixel, written); });
    }
    progress("voxelize", double(done += end - begin) / double(tasks.size()));
  });
  return chunks;
}

/// Fragments by the layer of bricks that they fall in, in draw order within each.
class Layers {
 public:
  Layers(const std::vector<std::vector<Fragment>>& chunks, size_t count) : begin_(count + 1) {
    std::vector<std::vector<size_t>> next(chunks.size(), std::vector<size_t>(count));
    const auto layer = [](const Fragment& f) { return size_t(f.voxel.z / Bricks::side); };
    parallel_for(chunks.size(), 1, [&](size_t chunk, size_t) {
      for (const Fragment& fragment : chunks[chunk]) ++next[chunk][layer(fragment)];
    });
    size_t total = 0;
    for (size_t k = 0; k < count; ++k) {
      begin_[k] = total;
      for (auto& counts : next) total += std::exchange(counts[k], total);
    }
    begin_[count] = total;
    fragments_.resize(total);
    parallel_for(chunks.size(), 1, [&](size_t chunk, size_t) {
      for (const Fragment& fragment : chunks[chunk]) fragments_[next[chunk][layer(fragment)]++] = &fragment;
    });
  }
  std::span<const Fragment* const> operator[](size_t k) const {
    return std::span(fragments_).subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }

 private:
  std::vector<size_t> begin_;
  std::vector<const Fragment*> fragments_;
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
          restored(surfaces.emission.empty() ? glm::vec3(0.0f) : surfaces.emission[i], count), true, true};
}

/// One layer of bricks, 8 slices of voxels. Bricks are made when something is written to them.
class LayerAverages {
 public:
  explicit LayerAverages(const glm::ivec3& size)
      : size_(size),
        bricks_((glm::ivec2(size) + Bricks::side - 1) / Bricks::side),
        table_(size_t(bricks_.x) * size_t(bricks_.y)) {}

  VoxelAverages& at(const glm::ivec3& v) {
    std::unique_ptr<Brick>& brick = table_[index(glm::ivec2(v) / Bricks::side)];
    if (!brick) brick = std::make_unique<Brick>();
    VoxelAverages& voxel = (*brick)[Bricks::offset(v)];
    count_ += !voxel.written;
    voxel.written = true;
    return voxel;
  }
  size_t count() const { return count_; }  ///< voxels that were ever asked for
  /// Calls visit(voxel, averages) for those, sorted z, y, x. @param first z of the layer's first slice
  template <class Visit>
  void for_each(int first, Visit&& visit) const {
    for (int z = first; z < first + Bricks::side; ++z)
      for (int y = 0; y < size_.y; ++y)
        for (int bx = 0; bx < bricks_.x; ++bx) {
          const Brick* brick = table_[index({bx, y / Bricks::side})].get();
          if (!brick) continue;
          for (int x = 0; x < Bricks::side; ++x) {
            const glm::ivec3 v(bx * Bricks::side + x, y, z);
            const VoxelAverages& voxel = (*brick)[Bricks::offset(v)];
            if (voxel.written) visit(v, voxel);
          }
        }
  }

 private:
  using Brick = std::array<VoxelAverages, Bricks::texels_per_brick>;
  size_t index(const glm::ivec2& brick) const { return size_t(brick.x) + size_t(bricks_.x) * size_t(brick.y); }

  glm::ivec3 size_;
  glm::ivec2 bricks_;
  std::vector<std::unique_ptr<Brick>> table_;
  size_t count_ = 0;
};

/// Layer k of the grid: what was there before, and what its fragments add.
LayerAverages average_layer(const SurfaceGrid& before, size_t k, std::span<const Fragment* const> fragments,
                            bool static_wins) {
  LayerAverages layer(before.grid.size);
  const auto slice = [](const glm::ivec3& voxel, int z) { return voxel.z < z; };
  const int first = int(k) * Bricks::side;
  const auto begin = std::lower_bound(before.voxels.begin(), before.voxels.end(), first, slice);
  const auto end = std::lower_bound(begin, before.voxels.end(), first + Bricks::side, slice);
  for (auto voxel = begin; voxel != end; ++voxel)
    layer.at(*voxel) = restored(before, size_t(voxel - before.voxels.begin()));
  for (const Fragment* fragment : fragments) {
    VoxelAverages& voxel = layer.at(fragment->voxel);
    if (voxel.fixed && static_wins) continue;
    voxel.albedo.add(fragment->albedo);
    voxel.normal.add(fragment->normal);
    voxel.emission.add(fragment->emission);
  }
  return layer;
}

void resize(SurfaceGrid& surfaces, size_t count) {
  surfaces.voxels.resize(count);
  surfaces.fragments.resize(count);
  surfaces.albedo.resize(count);
  surfaces.normal.resize(count);
  surfaces.centroid.resize(count);
  surfaces.emission.resize(count);
}

void store(SurfaceGrid& surfaces, size_t i, const glm::ivec3& index, const VoxelAverages& voxel, bool dynamic) {
  surfaces.voxels[i] = index;
  surfaces.fragments[i] = voxel.albedo.count;
  if (dynamic) surfaces.dynamic[i] = !voxel.fixed;
  surfaces.albedo[i] = glm::vec4(decoded(voxel.albedo), voxel.albedo.empty() ? 0.0f : 1.0f);
  surfaces.normal[i] = 2.0f * decoded(voxel.normal) - 1.0f;
  surfaces.centroid[i] = surfaces.grid.center(index);
  surfaces.emission[i] = decoded(voxel.emission);
}

}  // namespace

SurfaceGrid voxelize_raster(const Scene& scene, const SurfaceGrid& before, bool dynamic, const VoxelizeOptions& options,
                            const Progress& progress) {
  const Grid& grid = before.grid;
  assert(grid.size.x == grid.size.y && grid.size.x == grid.size.z);
  const std::vector<std::vector<Fragment>> drawn = draw(scene, grid, dynamic, progress);
  const size_t count = size_t((grid.size.z + Bricks::side - 1) / Bricks::side);
  const Layers fragments(drawn, count);
  std::vector<std::optional<LayerAverages>> layers(count);
  parallel_for(count, 1, [&](size_t k, size_t) {
    progress.check();
    layers[k] = average_layer(before, k, fragments[k], options.static_wins);
  });

  SurfaceGrid surfaces;
  surfaces.grid = grid;
  std::vector<size_t> next(count + 1);
  for (size_t k = 0; k < count; ++k) next[k + 1] = next[k] + layers[k]->count();
  resize(surfaces, next[count]);
  if (dynamic) surfaces.dynamic.resize(next[count]);
  parallel_for(count, 1, [&](size_t k, size_t) {
    layers[k]->for_each(int(k) * Bricks::side, [&](const glm::ivec3& index, const VoxelAverages& voxel) {
      store(surfaces, next[k]++, index, voxel, dynamic);
    });
  });
  if (std::ranges::all_of(surfaces.emission, [](const glm::vec3& e) { return e == glm::vec3(0.0f); }))
    surfaces.emission = {};
  return surfaces;
}

}  // namespace voxref
