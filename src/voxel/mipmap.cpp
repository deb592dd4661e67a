#include "voxel/mipmap.h"

#include <cassert>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "parallel.h"

namespace voxref {

namespace {

/// The children of a texel; child x + 2 y + 4 z by its position in the 2x2x2 block.
using Block = std::array<Float4, 8>;

/// Children at the positive end of the four columns along each axis, in the order in which the published shaders add
/// them (spec section 4).
constexpr size_t columns[3][4] = {
    {7, 3, 5, 1},  // x: (y,z) = (1,1) (1,0) (0,1) (0,0)
    {7, 3, 2, 6},  // y: (x,z) = (1,1) (1,0) (0,0) (0,1)
    {7, 5, 6, 4},  // z: (x,y) = (1,1) (1,0) (0,1) (0,0)
};

/// What a ray towards a face's direction sees of a texel of the level below; the base looks the same from everywhere.
template <class Texel>
Float4 seen(const Texel& base, size_t) {
  return decode(base);
}
template <class Texel>
Float4 seen(const Directional<Texel>& texel, size_t face) {
  return decode(texel[face]);
}
/// @param corner first texel of the block, in its brick
template <class Below>
Block seen_block(const Below* corner, size_t face) {
  constexpr size_t side = BrickVolume<Below>::side;
  Block block;
  for (size_t i = 0; i < block.size(); ++i)
    block[i] = seen(corner[(i & 1) + side * (i >> 1 & 1) + side * side * (i >> 2)], face);
  return block;
}

/// Whether nothing is stored in a block: this asks no texel for its channels.
template <class Below>
bool is_empty(const Below* corner) {
  constexpr size_t side = BrickVolume<Below>::side;
  using Row = std::array<uint64_t, 2 * sizeof(Below) / sizeof(uint64_t)>;  // two texels
  uint64_t any = 0;
  for (const size_t begin : {size_t{0}, side, side * side, side * side + side}) {
    Row row;
    std::memcpy(row.data(), corner + begin, sizeof row);
    for (const uint64_t word : row) any |= word;
  }
  return any == 0;
}

/// One face of a texel that is stored as `Texel`. Bytes are summed in the published shaders' order, so that they are
/// theirs to the bit; floats in pairs, so that a mirrored block has the same bits, and a turned one two roundings of
/// its own. Rounding never lifts opacity above 1: with the sum of the columns before at most c, a whole number, the
/// next is at most round(round(c + f) + round(1 - f)) where f is the front's opacity; the three roundings together miss
/// c + 1 by at most half a unit in its last place (both addends are multiples of 2^-24, and ties go to the even c + 1).
template <class Texel>
Float4 filter_face(const Block& block, size_t face) {
  const size_t axis = face / 2, along = size_t{1} << axis;
  const bool negative = face % 2 == 0;  // towards the negative side a ray meets the higher coordinate first
  const auto near = [&](size_t i) { return block[columns[axis][i] - (negative ? 0 : along)]; };
  const auto far = [&](size_t i) { return block[columns[axis][i] - (negative ? along : 0)]; };
  const auto behind = [&](size_t i) { return far(i) * (1.0f - near(i)[3]); };
  Float4 sum{};
  if constexpr (std::is_same_v<Texel, Rgba8>) {
    for (size_t i = 0; i < 4; ++i) {
      sum += near(i);
      sum += behind(i);
    }
  } else {
    const auto column = [&](size_t i) { return near(i) + behind(i); };
    sum = (column(0) + column(1)) + (column(2) + column(3));
  }
  return 0.25f * sum;
}

template <class Texel>
Directional<Texel> filter_anisotropic(const Texel* corner) {
  const Block block = seen_block(corner, 0);  // decoded once for all faces
  Directional<Texel> result;
  for (size_t face = 0; face < result.size(); ++face) result[face] = encode<Texel>(filter_face<Texel>(block, face));
  return result;
}
template <class Texel>
Directional<Texel> filter_anisotropic(const Directional<Texel>* corner) {
  Directional<Texel> result;
  for (size_t face = 0; face < result.size(); ++face)
    result[face] = encode<Texel>(filter_face<Texel>(seen_block(corner, face), face));
  return result;
}

template <class Texel, class Below>
Directional<Texel> filter_isotropic(const Below* corner) {
  Float4 sum{};
  for (const Float4& texel : seen_block(corner, 0)) sum += texel;
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

/// Fills the eighth of a coarse brick that one fine brick lies under: `octant` in {0,1}^3. The coarse brick is empty
/// before, and stays so where the fine one is: surfaces leave three of four blocks so.
template <class Texel, class Below>
void filter_octant(std::span<const Below, BrickVolume<Below>::texels_per_brick> fine, const glm::ivec3& octant,
                   MipmapFilter filter, std::span<Directional<Texel>, BrickVolume<Texel>::texels_per_brick> coarse) {
  constexpr int half = BrickVolume<Texel>::side / 2;
  for (int z = 0; z < half; ++z)
    for (int y = 0; y < half; ++y)
      for (int x = 0; x < half; ++x) {
        const Below* corner = &fine[BrickVolume<Below>::offset(2 * glm::ivec3(x, y, z))];
        if (is_empty(corner)) continue;
        coarse[BrickVolume<Texel>::offset(half * octant + glm::ivec3(x, y, z))] =
            filter == MipmapFilter::anisotropic ? filter_anisotropic(corner) : filter_isotropic<Texel>(corner);
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
template struct BasicPyramid<Rgba16f>;
template struct BasicPyramid<Rgba8>;
template Pyramid mipmap(const SurfaceGrid&, std::span<const glm::vec3>, const MipmapOptions&, const Progress&);
template Pyramid16 mipmap(const SurfaceGrid&, std::span<const glm::vec3>, const MipmapOptions&, const Progress&);
template Pyramid8 mipmap(const SurfaceGrid&, std::span<const glm::vec3>, const MipmapOptions&, const Progress&);
template Pyramid mipmap(const Grid&, BrickVolume<glm::vec4>, const MipmapOptions&, const Progress&);
template Pyramid16 mipmap(const Grid&, BrickVolume<Rgba16f>, const MipmapOptions&, const Progress&);
template Pyramid8 mipmap(const Grid&, BrickVolume<Rgba8>, const MipmapOptions&, const Progress&);

}  // namespace voxref
