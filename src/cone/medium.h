#pragma once
#include "voxel/mipmap.h"

namespace voxref {

/// A pyramid made ready for marching: every texel (premultiplied colour c, opacity a) turned into extinction
///
///   sigma = -ln(1 - min(a, 1 - 1e-4)) / (side of its cell in voxels)      and      sigma x c / a,
///
/// where a is the texel's opacity beside its neighbours, see optical_depths: oblique walls are opaque at all levels.
///
/// Interpolated so, n short steps attenuate as one long one, and a one-voxel wall stays opaque; interpolated opacity
/// would let e^-2 of the light through at every resolution (spec 5). Per voxel length rather than per cell, because
/// then a homogeneous medium and a wall keep their optical depth between two levels; per cell they would gain up to 6
/// %.
struct Medium {
  Pyramid texels;  ///< rgb: sigma x radiance, a: sigma, 1/voxel

  /// Coarsest level that can be sampled; 0 is the base volume, k is texels.levels[k - 1].
  int top() const { return static_cast<int>(texels.levels.size()); }
  /// Texels of a level have sides of this many voxels.
  static float cell(int level) { return static_cast<float>(1u << level); }
};

/// Converts in place; the pyramid's memory is taken over. @param filter of the pyramid; an isotropic one keeps its
/// leaks
Medium make_medium(Pyramid&& pyramid, MipmapFilter filter = MipmapFilter::anisotropic);
/// The same of what the half floats and bytes hold.
Medium make_medium(Pyramid16&& pyramid, MipmapFilter filter = MipmapFilter::anisotropic);
Medium make_medium(Pyramid8&& pyramid, MipmapFilter filter = MipmapFilter::anisotropic);

/// The finest level alone, without radiance, for marching shadows before anything is lit.
Medium make_opacity_medium(const SurfaceGrid& surfaces);

}  // namespace voxref
