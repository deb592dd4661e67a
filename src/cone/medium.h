#pragma once
#include "cone/occupancy.h"
#include "voxel/mipmap.h"

namespace voxref {

/// A pyramid made ready for marching: every texel (premultiplied colour c, opacity a) stands for its optical depth
/// through its whole side,
///
///   depth = -ln(1 - min(a, 1 - 1e-4))      and      depth x c / a,
///
/// where a is the texel's opacity beside its neighbours, see optical_depths: oblique walls are opaque at all levels.
/// How each storage holds the two says optical_texel.h.
///
/// Look-ups interpolate them over the cell's side in voxels, which is extinction. So n short steps attenuate as one
/// long one, and a one-voxel wall stays opaque; interpolated opacity would let e^-2 of the light through at every
/// resolution (spec 5). Per voxel length rather than per cell, because then a homogeneous medium and a wall keep their
/// optical depth between two levels; per cell they would gain up to 6 %.
template <class Texel>
struct BasicMedium {
  BasicPyramid<Texel> texels;  ///< optical ones
  Occupancy occupied;
  size_t depth_bytes = 0;  ///< that optical_depths held while it was made

  /// Coarsest level that can be sampled; 0 is the base volume, k is texels.levels[k - 1].
  int top() const { return static_cast<int>(texels.levels.size()); }
  size_t bytes() const { return texels.bytes() + occupied.bytes(); }
  /// Texels of a level have sides of this many voxels.
  static float cell(int level) { return static_cast<float>(1u << level); }
};
using Medium = BasicMedium<glm::vec4>;
using Medium16 = BasicMedium<Rgba16f>;
using Medium8 = BasicMedium<Rgba8>;

/// Converts in place; the pyramid's memory is taken over. @param filter of the pyramid; an isotropic one keeps its
/// leaks
template <class Texel>
BasicMedium<Texel> make_medium(BasicPyramid<Texel>&& pyramid, MipmapFilter filter = MipmapFilter::anisotropic);

/// The finest level alone, without radiance, for marching shadows before anything is lit.
Medium make_opacity_medium(const SurfaceGrid& surfaces);

}  // namespace voxref
