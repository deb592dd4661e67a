#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "progress.h"
#include "voxel/brick_volume.h"
#include "voxel/texel.h"
#include "voxel/voxelize.h"

namespace voxref {

/// Directional volumes, named after the way a ray travels: a ray towards -x reads neg_x and meets the higher-x texel
/// first.
enum class Face : uint8_t { neg_x, pos_x, neg_y, pos_y, neg_z, pos_z };
inline constexpr std::array<std::string_view, 6> face_names = {"neg_x", "pos_x", "neg_y", "pos_y", "neg_z", "pos_z"};

enum class MipmapFilter : uint8_t {
  anisotropic,  ///< composites front to back along each face's axis, then averages
  isotropic     ///< plain mean of eight, the same for all faces: lets colours and light through walls, kept to show it
};

struct MipmapOptions {
  MipmapFilter filter = MipmapFilter::anisotropic;
};

/// Premultiplied radiance (rgb) and opacity (a), six faces.
using DirectionalTexel = Directional<glm::vec4>;

/// Radiance and opacity of a grid at all scales, held in texels of one storage: glm::vec4, Rgba16f or Rgba8. Level k of
/// `levels` has texels of 2^(k+1) voxels a side and ceil(size / 2^(k+1)) of them, anchored at the grid's minimum corner
/// (what sticks out is empty), down to 1x1x1.
template <class Texel>
struct BasicPyramid {
  Grid grid;
  BrickVolume<Texel> base;  ///< premultiplied radiance (rgb) and opacity (a) per voxel
  std::vector<BrickVolume<Directional<Texel>>> levels;

  size_t bytes() const;
};
using Pyramid = BasicPyramid<glm::vec4>;
using Pyramid16 = BasicPyramid<Rgba16f>;
using Pyramid8 = BasicPyramid<Rgba8>;

/// Spec section 4. For each of the four columns of a 2x2x2 block along the face's axis front + back (1 - alpha_front),
/// all four channels premultiplied; the value is the mean of the four columns, rounded to what the texel can hold. In
/// bytes it is summed in the published shaders' order.
/// @param radiance one per occupied voxel, as `shade` returns it (not premultiplied)
template <class Texel = glm::vec4>
BasicPyramid<Texel> mipmap(const SurfaceGrid& surfaces, std::span<const glm::vec3> radiance,
                           const MipmapOptions& options, const Progress& progress = {});

/// The same from a base volume alone, for volumes that somebody else made.
template <class Texel>
BasicPyramid<Texel> mipmap(const Grid& grid, BrickVolume<Texel> base, const MipmapOptions& options,
                           const Progress& progress = {});

}  // namespace voxref
