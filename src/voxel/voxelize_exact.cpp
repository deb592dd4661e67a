#include "voxel/voxelize_exact.h"

#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>

#include "parallel.h"
#include "voxel/brick_volume.h"
#include "voxel/material_filter.h"
#include "voxel/triangle_bins.h"

namespace voxref {

namespace {

using Bricks = BrickVolume<float>;  // for its brick layout alone

/// Area-weighted sums over the pieces in a voxel. Lengths and areas in voxels.
struct Sums {
  double area = 0.0;
  glm::dvec3 albedo{0.0}, normal{0.0}, centroid{0.0}, emission{0.0};
  double projected = 0.0;  ///< area seen along view_axis, where coverage is asked for

  glm::dvec3 mean_normal() const { return normal / area; }
};

/// A piece whose projection is needed once the voxel's mean normal is known.
struct Facet {
  size_t voxel;            ///< offset in the brick
  glm::dvec3 vector_area;  ///< of what is covered
};

/// An occupied voxel, finished.
struct Voxel {
  glm::ivec3 index;
  float area;
  glm::vec4 albedo;
  glm::vec3 normal, centroid, emission;
};

/// Centroid of a piece, in space and in barycentric coordinates. @param normal unit, of the triangle
ClipVertex centroid_of(const ClipPolygon& piece, const glm::dvec3& normal) {
  ClipVertex sum;
  double total = 0.0;
  for (int i = 2; i < piece.size(); ++i) {
    const ClipVertex &a = piece[0], &b = piece[i - 1], &c = piece[i];
    const double area = glm::dot(glm::cross(b.position - a.position, c.position - a.position), normal);
    sum.position += area / 3.0 * (a.position + b.position + c.position);
    sum.uv += area / 3.0 * (a.uv + b.uv + c.uv);
    total += area;
  }
  return {sum.position / total, sum.uv / total};
}

/// The interpolated vertex normal, unit, on the front's side: what the surface looks like, as its tessellation is an
/// accident. Normal maps are left out: their detail is far below a voxel, and its mean is the interpolated normal.
glm::dvec3 shading_normal(const Scene& scene, uint32_t triangle, const glm::dvec2& uv, const glm::dvec3& front) {
  const glm::uvec3& corners = scene.triangles[triangle];
  const glm::dvec3 normal = (1.0 - uv.x - uv.y) * glm::dvec3(scene.normals[corners.x]) +
                            uv.x * glm::dvec3(scene.normals[corners.y]) + uv.y * glm::dvec3(scene.normals[corners.z]);
  const double length = glm::length(normal);
  if (!(length > 0.0)) return front;
  return (glm::dot(normal, front) < 0.0 ? -1.0 : 1.0) / length * normal;
}

/// The direction along which a voxel's coverage is seen; zero where its mean normal says nothing.
glm::dvec3 view_axis(const glm::dvec3& mean_normal) {
  const double length = glm::length(mean_normal);
  return length >= two_sided_length ? mean_normal / length : glm::dvec3(0.0);
}

/// Area of a facet's projection along `axis`; without an axis averaged over all directions, half its area.
double projection(const glm::dvec3& vector_area, const glm::dvec3& axis) {
  return axis == glm::dvec3(0.0) ? 0.5 * glm::length(vector_area) : std::abs(glm::dot(vector_area, axis));
}

/// The same for the unit cube; a convex body's mean is a quarter of its surface (Cauchy 1841).
double cube_projection(const glm::dvec3& axis) {
  return axis == glm::dvec3(0.0) ? 1.5 : std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z);
}

/// Voxelizes one brick at a time; bricks do not know of each other.
class BrickVoxelizer {
 public:
  BrickVoxelizer(const Scene& scene, const VoxelTriangles& triangles, const MaterialFilter& filter,
                 VoxelOpacity opacity)
      : scene_(scene), triangles_(triangles), filter_(filter), opacity_(opacity), sums_(Bricks::texels_per_brick) {}

  /// The brick's occupied voxels, sorted z, y, x.
  std::vector<Voxel> operator()(const glm::ivec3& brick, std::span<const uint32_t> triangles) {
    std::fill(sums_.begin(), sums_.end(), Sums{});
    facets_.clear();
    const glm::ivec3 first = brick * Bricks::side;
    for (const uint32_t t : triangles) add_triangle(t, first);
    for (const Facet& facet : facets_)
      sums_[facet.voxel].projected += projection(facet.vector_area, view_axis(sums_[facet.voxel].mean_normal()));
    std::vector<Voxel> result;
    for (size_t i = 0; i < sums_.size(); ++i)
      // Less area than rounding makes of nothing is nothing.
      if (sums_[i].area > triangles_.rounding() * triangles_.rounding())
        result.push_back(finish(
            first + glm::ivec3(i % Bricks::side, i / Bricks::side % Bricks::side, i / (Bricks::side * Bricks::side)),
            i));
    return result;
  }

 private:
  void add_triangle(uint32_t triangle, const glm::ivec3& first) {
    const ClipPolygon whole = triangles_(triangle);
    const glm::dvec3 twice_area = twice_vector_area(whole);
    const double length = glm::length(twice_area);
    const TrianglePlane plane{triangle, twice_area / length, 0.5 * length};
    const glm::ivec3 last = glm::min(first + Bricks::side, triangles_.grid().size);
    const ClipPolygon inside = clip_to_box(whole, glm::dvec3(first), glm::dvec3(last));
    if (inside.empty()) return;
    for_each_cell(inside, 1, first, last, [&](const glm::ivec3& voxel, const ClipPolygon& piece, double share) {
      add_piece(plane, Bricks::offset(voxel), piece, share);
    });
  }

  void add_piece(const TrianglePlane& plane, size_t voxel, const ClipPolygon& piece, double share) {
    const double whole_area = 0.5 * glm::dot(twice_vector_area(piece), plane.front);
    if (!(whole_area > 0.0)) return;
    const ClipVertex centroid = centroid_of(piece, plane.front);
    const FilteredMaterial material = filter_(plane, piece, centroid.uv);
    const double area = share * whole_area * material.coverage;
    if (!(area > 0.0)) return;
    Sums& sums = sums_[voxel];
    sums.area += area;
    sums.albedo += area * material.albedo;
    sums.emission += area * material.emission;
    sums.normal += area * shading_normal(scene_, plane.triangle, centroid.uv, plane.front);
    sums.centroid += area * centroid.position;
    if (opacity_ == VoxelOpacity::coverage) facets_.push_back({voxel, area * plane.front});
  }

  Voxel finish(const glm::ivec3& index, size_t voxel) const {
    const Sums& sums = sums_[voxel];
    const Grid& grid = triangles_.grid();
    const double opacity = opacity_ == VoxelOpacity::occupied
                               ? 1.0
                               : std::min(1.0, sums.projected / cube_projection(view_axis(sums.mean_normal())));
    return {index,
            float(sums.area * grid.voxel * grid.voxel),
            glm::vec4(sums.albedo / sums.area, opacity),
            glm::vec3(sums.mean_normal()),
            glm::vec3(glm::dvec3(grid.min) + double(grid.voxel) * sums.centroid / sums.area),
            glm::vec3(sums.emission / sums.area)};
  }

  const Scene& scene_;
  const VoxelTriangles& triangles_;
  const MaterialFilter& filter_;
  VoxelOpacity opacity_;
  std::vector<Sums> sums_;  ///< one per voxel of the brick
  std::vector<Facet> facets_;
};

void store(SurfaceGrid& surfaces, size_t i, const Voxel& voxel) {
  surfaces.voxels[i] = voxel.index;
  surfaces.area[i] = voxel.area;
  surfaces.albedo[i] = voxel.albedo;
  surfaces.normal[i] = voxel.normal;
  surfaces.centroid[i] = voxel.centroid;
  if (!surfaces.emission.empty()) surfaces.emission[i] = voxel.emission;
}

/// Sorts the voxels of all bricks by z, y, x: bricks come in that order, and so do the voxels of each, so a counting
/// sort by row of the grid does it. Bricks are freed as they are copied.
SurfaceGrid merge(const Grid& grid, std::vector<std::vector<Voxel>>&& bricks, bool emission) {
  const auto row = [&](const glm::ivec3& v) { return size_t(v.y) + size_t(grid.size.y) * size_t(v.z); };
  std::vector<size_t> next(size_t(grid.size.y) * size_t(grid.size.z) + 1);
  for (const auto& brick : bricks)
    for (const Voxel& voxel : brick) ++next[row(voxel.index) + 1];
  for (size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];

  SurfaceGrid surfaces;
  surfaces.grid = grid;
  surfaces.resize(next.back(), emission);
  surfaces.area.resize(surfaces.size());
  for (auto& brick : bricks) {
    for (const Voxel& voxel : brick) store(surfaces, next[row(voxel.index)]++, voxel);
    brick = std::vector<Voxel>();  // {} would keep the memory
  }
  return surfaces;
}

}  // namespace

SurfaceGrid voxelize_exact(const Scene& scene, const Grid& grid, bool dynamic, const VoxelizeOptions& options,
                           const Progress& progress) {
  const VoxelTriangles triangles(scene, grid);
  std::vector<bool> chosen(scene.triangles.size());
  for (const Object& object : scene.objects)
    std::fill_n(chosen.begin() + object.first_triangle, object.triangle_count, object.dynamic == dynamic);
  const TriangleBins bins = bin_triangles(triangles, chosen, progress);
  const MaterialFilter filter(scene);
  std::vector<std::vector<Voxel>> bricks(bins.bins.size());
  std::atomic<size_t> finished = 0;
  constexpr size_t grain = 8;  // bricks: enough work to be worth a task, few enough to keep cores busy to the end
  parallel_for(bricks.size(), grain, [&](size_t begin, size_t end) {
    progress.check();
    BrickVoxelizer voxelizer(scene, triangles, filter, options.opacity);
    for (size_t i = begin; i < end; ++i) {
      const TriangleBin& bin = bins.bins[i];
      bricks[i] = voxelizer(bin.brick, std::span(bins.triangles).subspan(bin.begin, bin.end - bin.begin));
    }
    progress("voxelize", double(finished += end - begin) / double(bricks.size()));
  });
  return merge(grid, std::move(bricks), scene.has_emission());
}

}  // namespace voxref
