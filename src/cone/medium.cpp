#include "cone/medium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel.h"

namespace voxref {
namespace {

/// Opacity is held below 1 by this much, since no finite extinction is opaque; one wall transmits as much.
constexpr float transparency_floor = 1e-4f;

/// A texel in a cell of `cell` voxels a side; without opacity it has no colour either.
glm::vec4 extinction(const glm::vec4& texel, float cell) {
  if (texel.a == 0.0f) return glm::vec4(0.0f);
  const float sigma = -std::log1p(-std::min(texel.a, 1.0f - transparency_floor)) / cell;
  const glm::vec3 weighted = glm::vec3(texel) * (sigma / texel.a);
  return {weighted, sigma};
}

constexpr size_t grain = 4096;  // texels: long enough to hide the cost of a task

void convert(BrickVolume<glm::vec4>& volume) {
  const std::span<glm::vec4> texels = volume.texels();
  parallel_for(texels.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) texels[i] = extinction(texels[i], 1.0f);
  });
}

void convert(BrickVolume<DirectionalTexel>& volume, float cell) {
  const std::span<DirectionalTexel> texels = volume.texels();
  parallel_for(texels.size(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (glm::vec4& face : texels[i]) face = extinction(face, cell);
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

}  // namespace

Medium make_medium(Pyramid8&& pyramid) {
  const auto decoded = [](const Rgba8& texel) { return to_vec4(decode(texel)); };
  Pyramid floats{pyramid.grid, converted<glm::vec4>(pyramid.base, decoded), {}};
  pyramid.base = {};
  for (BrickVolume<Directional<Rgba8>>& level : pyramid.levels) {
    floats.levels.push_back(converted<DirectionalTexel>(level, [&](const Directional<Rgba8>& texel) {
      DirectionalTexel faces;
      for (size_t face = 0; face < faces.size(); ++face) faces[face] = decoded(texel[face]);
      return faces;
    }));
    level = {};
  }
  return make_medium(std::move(floats));
}

Medium make_medium(Pyramid&& pyramid) {
  Medium medium{std::move(pyramid)};
  convert(medium.texels.base);
  for (int level = 1; level <= medium.top(); ++level)
    convert(medium.texels.levels[static_cast<size_t>(level - 1)], Medium::cell(level));
  return medium;
}

Medium make_opacity_medium(const SurfaceGrid& surfaces) {
  Medium medium;
  medium.texels.grid = surfaces.grid;
  BrickVolume<glm::vec4>& base = medium.texels.base;
  base = BrickVolume<glm::vec4>(surfaces.grid.size);

  base.allocate(occupied_bricks(surfaces));
  for (size_t i = 0; i < surfaces.size(); ++i)
    base(surfaces.voxels[i]) = extinction({0.0f, 0.0f, 0.0f, surfaces.albedo[i].a}, 1.0f);
  return medium;
}

}  // namespace voxref
