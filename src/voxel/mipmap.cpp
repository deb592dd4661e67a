#include "voxel/mipmap.h"

#include <cassert>
#include <cmath>

#include "parallel.h"

namespace voxref {

namespace {

/// The children of a texel, [x][y][z] by their position in the 2x2x2 block.
template <class Texel>
using Block = std::array<std::array<std::array<Texel, 2>, 2>, 2>;

/// Positions in a block of the four columns along each axis, as the two other coordinates in ascending axis order, in
/// the order in which the published shaders add them (spec section 4): float sums then have the same bits.
constexpr int columns[3][4][2] = {
    {{1, 1}, {1, 0}, {0, 1}, {0, 0}},  // x: (y,z)
    {{1, 1}, {1, 0}, {0, 0}, {0, 1}},  // y: (x,z)
    {{1, 1}, {1, 0}, {0, 1}, {0, 0}},  // z: (x,y)
};

/// The block's texel in column `column` along `axis`, at position `along` on that axis.
template <class Texel>
const Texel& in_column(const Block<Texel>& block, int axis, int column, int along) {
  const auto [p, q] = columns[axis][column];
  return axis == 0 ? block[along][p][q] : axis == 1 ? block[p][along][q] : block[p][q][along];
}

/// What a ray towards a face's direction sees of a texel of the level below; the base looks the same from everywhere.
template <class Texel>
Float4 seen(const Texel& base, size_t) {
  return decode(base);
}
template <class Texel>
Float4 seen(const Directional<Texel>& texel, size_t face) {
  return decode(texel[face]);
}

// Rounding never lifts opacity above 1. With the sum of the columns before at most c, a whole number, the next is at
// most round(round(c + f) + round(1 - f)) where f is the front's opacity; the three roundings together miss c + 1 by at
// most half a unit in its last place (both addends are multiples of 2^-24, and ties go to the even c + 1).
template <class Texel, class Below>
Directional<Texel> filter_anisotropic(const Block<Below>& block) {
  Directional<Texel> result;
  for (size_t face = 0; face < 6; ++face) {
    const int axis = int(face) / 2;
    const int front = face % 2 == 0 ? 1 : 0;  // towards the negative side a ray meets the higher coordinate first
    Float4 sum{};
    for (int column = 0; column < 4; ++column) {
      const Float4 near = seen(in_column(block, axis, column, front), face);
      const Float4 far = seen(in_column(block, axis, column, 1 - front), face);
      sum += near;
      sum += far * (1.0f - near[3]);
    }
    result[face] = encode<Texel>(0.25f * sum);
  }
  return result;
}

template <class Texel, class Below>
Directional<Texel> filter_isotropic(const Block<Below>& block) {
  Float4 sum{};
  for (const auto& plane : block)
    for (const auto& row : plane)
      for (const Below& texel : row) sum += seen(texel, 0);
  Directional<Texel> result;
  result.fill(encode<Texel>(0.125f * sum));
  return result;
}

/// Bricks of the next level that have a brick below them.
template <class Below, class Texel>
std::vector<glm::ivec3> parents(const BrickVolume<Below>& fine, const BrickVolume<Texel>& coarse) {
  BrickSet bricks(coarse.brick_grid());
  const glm::ivec3 below = fine.brick_grid();
  for (int z = 0; z < below.z; ++z)
    for (int y = 0; y < below.y; ++y)
      for (int x = 0; x < below.x; ++x)
        if (fine.slot({x, y, z}) != fine.absent) bricks.add({x / 2, y / 2, z / 2});
  return bricks.sorted();
}

/// Fills the eighth of a coarse brick that one fine brick lies under: `octant` in {0,1}^3.
template <class Texel, class Below>
void filter_octant(std::span<const Below, BrickVolume<Below>::texels_per_brick> fine, const glm::ivec3& octant,
                   MipmapFilter filter, std::span<Directional<Texel>, BrickVolume<Texel>::texels_per_brick> coarse) {
  constexpr int half = BrickVolume<Texel>::side / 2;
  for (int z = 0; z < half; ++z)
    for (int y = 0; y < half; ++y)
      for (int x = 0; x < half; ++x) {
        Block<Below> block;
        for (int i = 0; i < 8; ++i) {
          const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2);
          block[corner.x][corner.y][corner.z] = fine[BrickVolume<Texel>::offset(2 * glm::ivec3(x, y, z) + corner)];
        }
        coarse[BrickVolume<Texel>::offset(half * octant + glm::ivec3(x, y, z))] =
            filter == MipmapFilter::anisotropic ? filter_anisotropic<Texel>(block) : filter_isotropic<Texel>(block);
      }
}

/// One level from the one below. Sides are even in bricks, so a 2x2x2 block never crosses a brick, and texels of a
/// brick that stick out of the volume are empty like those of absent bricks.
template <class Texel, class Below>
BrickVolume<Directional<Texel>> coarser(const BrickVolume<Below>& fine, MipmapFilter filter, const Progress& progress) {
  BrickVolume<Directional<Texel>> coarse((fine.size() + 1) / 2);
  const std::vector<glm::ivec3> bricks = parents(fine, coarse);
  coarse.allocate(bricks);
  parallel_for(bricks.size(), 4, [&](size_t begin, size_t end) {
    progress.check();
    for (size_t i = begin; i < end; ++i)
      for (int child = 0; child < 8; ++child) {
        const glm::ivec3 octant(child & 1, (child >> 1) & 1, child >> 2), below = 2 * bricks[i] + octant;
        if (below.x >= fine.brick_grid().x || below.y >= fine.brick_grid().y || below.z >= fine.brick_grid().z)
          continue;
        const uint32_t slot = fine.slot(below);
        if (slot != fine.absent)
          filter_octant<Texel, Below>(fine.brick(slot), octant, filter, coarse.brick(uint32_t(i)));
      }
  });
  return coarse;
}

/// The base volume of shaded surfaces.
template <class Texel>
BrickVolume<Texel> premultiplied(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance) {
  BrickVolume<Texel> base(surfaces.grid.size);
  base.allocate(occupied_bricks(surfaces));
  parallel_for(surfaces.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const float opacity = surfaces.albedo[i].a;
      base(surfaces.voxels[i]) = encode<Texel>(load(glm::vec4(opacity * radiance[i], opacity)));
    }
  });
  return base;
}

}  // namespace

template <class Texel>
size_t BasicPyramid<Texel>::bytes() const {
  size_t total = base.bytes();
  for (const auto& level : levels) total += level.bytes();
  return total;
}

template <class Texel>
BasicPyramid<Texel> mipmap(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance,
                           const MipmapOptions& options, const Progress& progress) {
  assert(radiance.size() == surfaces.size());
  return mipmap(surfaces.grid, premultiplied<Texel>(surfaces, radiance), options, progress);
}

template <class Texel>
BasicPyramid<Texel> mipmap(const Grid& grid, BrickVolume<Texel> base, const MipmapOptions& options,
                           const Progress& progress) {
  assert(base.size() == grid.size);
  BasicPyramid<Texel> pyramid{grid, std::move(base), {}};
  const auto finished = [](const glm::ivec3& size) { return size.x <= 1 && size.y <= 1 && size.z <= 1; };
  if (!finished(grid.size)) pyramid.levels.push_back(coarser<Texel>(pyramid.base, options.filter, progress));
  while (!pyramid.levels.empty() && !finished(pyramid.levels.back().size())) {
    // Each level is an eighth of the one below.
    progress("mipmap", 1.0 - std::pow(0.125, double(pyramid.levels.size())));
    pyramid.levels.push_back(coarser<Texel>(pyramid.levels.back(), options.filter, progress));
  }
  progress("mipmap", 1.0);
  return pyramid;
}

template struct BasicPyramid<glm::vec4>;
template struct BasicPyramid<Rgba8>;
template Pyramid mipmap(const SurfaceGrid&, std::span<const glm::vec3>, const MipmapOptions&, const Progress&);
template Pyramid8 mipmap(const SurfaceGrid&, std::span<const glm::vec3>, const MipmapOptions&, const Progress&);
template Pyramid mipmap(const Grid&, BrickVolume<glm::vec4>, const MipmapOptions&, const Progress&);
template Pyramid8 mipmap(const Grid&, BrickVolume<Rgba8>, const MipmapOptions&, const Progress&);

}  // namespace voxref
