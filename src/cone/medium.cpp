#include "cone/medium.h"

#include <algorithm>
#include <utility>

#include "cone/optical_depth.h"
#include "cone/optical_texel.h"
#include "parallel.h"

namespace voxref {
namespace {

constexpr size_t grain = 4096;  // texels: long enough to hide the cost of a task

template <class Texel>
void convert(BrickVolume<Texel>& volume) {
  const std::span<Texel> texels = volume.texels();
  parallel_for(texels.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (texels[i] == Texel{}) continue;
      const glm::vec4 lit = to_vec4(decode(texels[i]));
      texels[i] = optical_texel<Texel>(lit, optical_depth(lit.a));
    }
  });
}

/// @param depths of the same bricks, or null for what each texel's opacity says by itself
template <class Texel>
void convert(BrickVolume<Directional<Texel>>& volume, const BrickVolume<glm::vec3>* depths) {
  const std::span<Directional<Texel>> texels = volume.texels();
  parallel_for(texels.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (texels[i] == Directional<Texel>{}) continue;  // three of four
      for (size_t face = 0; face < 6; ++face) {
        const glm::vec4 lit = to_vec4(decode(texels[i][face]));
        const float alone = optical_depth(lit.a);
        const float depth = depths ? std::max(alone, depths->texels()[i][static_cast<int>(face / 2)]) : alone;
        texels[i][face] = optical_texel<Texel>(lit, depth);
      }
    }
  });
}

}  // namespace

template <class Texel>
BasicMedium<Texel> make_medium(BasicPyramid<Texel>&& pyramid, MipmapFilter filter) {
  std::vector<BrickVolume<glm::vec3>> depths;
  if (filter == MipmapFilter::anisotropic) depths = optical_depths(pyramid);
  Occupancy occupied(pyramid);
  BasicMedium<Texel> medium{std::move(pyramid), std::move(occupied)};
  convert(medium.texels.base);
  for (size_t k = 0; k < medium.texels.levels.size(); ++k)
    convert(medium.texels.levels[k], depths.empty() ? nullptr : &depths[k]);
  for (const BrickVolume<glm::vec3>& level : depths) medium.depth_bytes += level.bytes();
  return medium;
}

template Medium make_medium(Pyramid&&, MipmapFilter);
template Medium16 make_medium(Pyramid16&&, MipmapFilter);
template Medium8 make_medium(Pyramid8&&, MipmapFilter);

Medium make_opacity_medium(const SurfaceGrid& surfaces) {
  Medium medium;
  medium.texels.grid = surfaces.grid;
  BrickVolume<glm::vec4>& base = medium.texels.base;
  base = BrickVolume<glm::vec4>(surfaces.grid.size);

  base.allocate(occupied_bricks(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i)
    base(surfaces.voxels[i]) = {0.0f, 0.0f, 0.0f, optical_depth(surfaces.albedo[i].a)};
  medium.occupied = Occupancy(medium.texels);
  return medium;
}

}  // namespace voxref
