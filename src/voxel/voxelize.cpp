#include "voxel/voxelize.h"

#include <algorithm>

#include "voxel/brick_volume.h"
#include "voxel/voxelize_exact.h"
#include "voxel/voxelize_raster.h"

namespace voxref {

namespace {

/// Builds a grid voxel by voxel out of those of two others that have areas.
class AreaMerge {
 public:
  AreaMerge(const SurfaceGrid& fixed, const SurfaceGrid& moving, bool static_wins)
      : fixed_(fixed), moving_(moving), static_wins_(static_wins) {
    result_.grid = fixed.grid;
  }

  SurfaceGrid operator()() {
    size_t f = 0, m = 0;
    while (f < fixed_.size() || m < moving_.size()) {
      if (m == moving_.size() || (f < fixed_.size() && before(fixed_.voxels[f], moving_.voxels[m])))
        copy(fixed_, f++, false);
      else if (f == fixed_.size() || before(moving_.voxels[m], fixed_.voxels[f]))
        copy(moving_, m++, true);
      else if (static_wins_)
        copy(fixed_, f++, false), ++m;
      else
        mix(f++, m++);
    }
    return std::move(result_);
  }

 private:
  void copy(const SurfaceGrid& from, size_t i, bool dynamic) {
    result_.voxels.push_back(from.voxels[i]);
    result_.dynamic.push_back(dynamic);
    result_.area.push_back(from.area[i]);
    result_.albedo.push_back(from.albedo[i]);
    result_.normal.push_back(from.normal[i]);
    result_.centroid.push_back(from.centroid[i]);
    if (!from.emission.empty()) result_.emission.push_back(from.emission[i]);
  }
  void mix(size_t f, size_t m) {
    const float area = fixed_.area[f] + moving_.area[m], share = moving_.area[m] / area;
    const auto mean = [&](const auto& values) {
      return (1.0f - share) * (fixed_.*values)[f] + share * (moving_.*values)[m];
    };
    glm::vec4 albedo = mean(&SurfaceGrid::albedo);
    // Opacity does not average: together they cover at least as much as either alone, at most their sum.
    albedo.a = std::min(1.0f, fixed_.albedo[f].a + moving_.albedo[m].a);
    result_.voxels.push_back(fixed_.voxels[f]);
    result_.dynamic.push_back(false);
    result_.area.push_back(area);
    result_.albedo.push_back(albedo);
    result_.normal.push_back(mean(&SurfaceGrid::normal));
    result_.centroid.push_back(mean(&SurfaceGrid::centroid));
    if (!fixed_.emission.empty()) result_.emission.push_back(mean(&SurfaceGrid::emission));
  }

  const SurfaceGrid &fixed_, &moving_;
  bool static_wins_;
  SurfaceGrid result_;
};

SurfaceGrid empty_grid(const Grid& grid) {
  SurfaceGrid surfaces;
  surfaces.grid = grid;
  return surfaces;
}

}  // namespace

void SurfaceGrid::resize(size_t count, bool emits) {
  voxels.resize(count);
  albedo.resize(count);
  normal.resize(count);
  centroid.resize(count);
  if (emits) emission.resize(count);
}

size_t SurfaceGrid::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return of(voxels) + of(area) + of(fragments) + of(dynamic) + of(albedo) + of(normal) + of(centroid) + of(emission);
}

std::vector<glm::ivec3> occupied_bricks(const SurfaceGrid& surfaces) {
  constexpr int side = BrickVolume<float>::side;
  BrickSet bricks((surfaces.grid.size + side - 1) / side);
  for (const glm::ivec3& voxel : surfaces.voxels) bricks.add(voxel / side);
  return bricks.sorted();
}

SurfaceGrid voxelize_static(const Scene& scene, const Grid& grid, const VoxelizeOptions& options,
                            const Progress& progress) {
  if (options.method == VoxelizeMethod::exact) return voxelize_exact(scene, grid, false, options, progress);
  return voxelize_raster(scene, empty_grid(grid), false, options, progress);
}

SurfaceGrid add_dynamic(const Scene& scene, SurfaceGrid fixed, const VoxelizeOptions& options,
                        const Progress& progress) {
  if (std::ranges::none_of(scene.objects, &Object::dynamic)) return fixed;
  if (options.average == VoxelAverage::running_floor8) return voxelize_raster(scene, fixed, true, options, progress);
  const SurfaceGrid moving = options.method == VoxelizeMethod::exact
                                 ? voxelize_exact(scene, fixed.grid, true, options, progress)
                                 : voxelize_raster(scene, empty_grid(fixed.grid), true, options, progress);
  return AreaMerge(fixed, moving, options.static_wins)();
}

SurfaceGrid voxelize(const Scene& scene, const Grid& grid, const VoxelizeOptions& options, const Progress& progress) {
  return add_dynamic(scene, voxelize_static(scene, grid, options, progress), options, progress);
}

}  // namespace voxref
