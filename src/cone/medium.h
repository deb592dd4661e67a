#pragma once
#include "voxel/mipmap.h"

namespace voxref {

/// A pyramid made ready for marching: every texel (premultiplied colour c, opacity a) turned into extinction per cell
/// sigma = -ln(1 - min(a, 1 - 1e-4)) and sigma x c / a. Interpolated so, n short steps attenuate as one long one, and a
/// one-voxel wall stays opaque; interpolated opacity would let e^-2 of the light through at every resolution. Spec 5.
struct Medium {
  Pyramid texels;  ///< rgb: sigma x colour ratio, a: sigma
};

/// Converts in place; the pyramid's memory is taken over.
Medium make_medium(Pyramid&& pyramid);

/// The finest level alone, without radiance, for marching shadows before anything is lit.
Medium make_opacity_medium(const SurfaceGrid& surfaces);

}  // namespace voxref
