#pragma once
#include <utility>

#include "cone/occupancy.h"
#include "voxel/mipmap.h"

namespace voxref {

/// A pyramid that raw cones march through as it is stored, and where they find anything in it.
template <class Texel>
struct BasicRawVolume {
  BasicPyramid<Texel> texels;
  Occupancy occupied;

  /// Takes the pyramid's memory over.
  BasicRawVolume(BasicPyramid<Texel>&& pyramid) : texels(std::move(pyramid)), occupied(texels) {}
};
using RawVolume = BasicRawVolume<glm::vec4>;
using RawVolume16 = BasicRawVolume<Rgba16f>;
using RawVolume8 = BasicRawVolume<Rgba8>;

}  // namespace voxref
