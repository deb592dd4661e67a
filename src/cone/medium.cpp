#include "cone/medium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cone/optical_depth.h"
#include "parallel.h"

namespace voxref {
namespace {

/// A texel of the given extinction; without opacity it has no colour either.
glm::vec4 extinction(const glm::vec4& texel, float sigma) {
  if (texel.a == 0.0f) return glm::vec4(0.0f);
  return {glm::vec3(texel) * (sigma / texel.a), sigma};
}

constexpr size_t grain = 4096;  // texels: long enough to hide the cost of a task

void convert(BrickVolume<glm::vec4>& volume) {
  const std::span<glm::vec4> texels = volume.texels();
  parallel_for(texels.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) texels[i] = extinction(texels[i], optical_depth(texels[i].a));
  });
}

/// @param depths of the same bricks, or null for what each texel's opacity says by itself
void convert(BrickVolume<DirectionalTexel>& volume, const BrickVolume<glm::vec3>* depths, float cell) {
  const std::span<DirectionalTexel> texels = volume.texels();
  parallel_for(texels.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (size_t face = 0; face < 6; ++face) {
        glm::vec4& texel = texels[i][face];
        const float alone = optical_depth(texel.a);
        const float depth = depths ? std::max(alone, depths->texels()[i][static_cast<int>(face / 2)]) : alone;
        texel = extinction(texel, depth / cell);
      }
  });
}

/// The same volume with texels that decode `texel` finds for each.
template <class To, class From, class Decode>
BrickVolume<To> converted(const BrickVolume<From>& from, Decode&& decode_texel) {
  BrickVolume<To> to(from.size());
  to.allocate(from.bricks());
  const std::span<const From> source = from.texels();
  const std::span<To> target = to.texels();
  parallel_for(source.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) target[i] = decode_texel(source[i]);
  });
  return to;
}

/// The same pyramid in floats; the other's memory is freed level by level.
template <class Texel>
Pyramid in_floats(BasicPyramid<Texel>&& pyramid) {
  const auto decoded = [](const Texel& texel) { return to_vec4(decode(texel)); };
  Pyramid floats{pyramid.grid, converted<glm::vec4>(pyramid.base, decoded), {}};
  pyramid.base = {};
  for (BrickVolume<Directional<Texel>>& level : pyramid.levels) {
    floats.levels.push_back(converted<DirectionalTexel>(level, [&](const Directional<Texel>& texel) {
      DirectionalTexel faces;
      for (size_t face = 0; face < faces.size(); ++face) faces[face] = decoded(texel[face]);
      return faces;
    }));
    level = {};
  }
  return floats;
}

}  // namespace

Medium make_medium(Pyramid16&& pyramid, MipmapFilter filter) {
  return make_medium(in_floats(std::move(pyramid)), filter);
}
Medium make_medium(Pyramid8&& pyramid, MipmapFilter filter) {
  return make_medium(in_floats(std::move(pyramid)), filter);
}

Medium make_medium(Pyramid&& pyramid, MipmapFilter filter) {
  std::vector<BrickVolume<glm::vec3>> depths;
  if (filter == MipmapFilter::anisotropic) depths = optical_depths(pyramid);
  Medium medium{std::move(pyramid)};
  convert(medium.texels.base);
  for (size_t k = 0; k < medium.texels.levels.size(); ++k)
    convert(medium.texels.levels[k], depths.empty() ? nullptr : &depths[k], Medium::cell(static_cast<int>(k) + 1));
  return medium;
}

Medium make_opacity_medium(const SurfaceGrid& surfaces) {
  Medium medium;
  medium.texels.grid = surfaces.grid;
  BrickVolume<glm::vec4>& base = medium.texels.base;
  base = BrickVolume<glm::vec4>(surfaces.grid.size);

  base.allocate(occupied_bricks(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i)
    base(surfaces.voxels[i]) = {0.0f, 0.0f, 0.0f, optical_depth(surfaces.albedo[i].a)};
  return medium;
}

}  // namespace voxref
