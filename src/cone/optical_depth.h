#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "voxel/mipmap.h"

namespace voxref {

/// Optical depths of the texels of all levels along x, y and z, through their whole side, in Pyramid::levels' order.
///
/// The filter (spec section 4) takes what texels behind each other cover for independent: front + back (1 - front). But
/// the two texels that an oblique wall passes through one after the other each cover just the columns that the other
/// leaves open. Together they are opaque, and 1/2 + 1/2 (1 - 1/2) = 3/4 leaks, worse so with each level. Here a texel P
/// before a texel T adds to both, half to each, what their depths lack of what they have together:
///
///   e(P,T) = D(mean over columns of A(t_P + t_T)) - D(mean of A(t_P)) - D(mean of A(t_T)),   D = depth, A = opacity,
///
/// over the four columns of the level below, t being the sum of a column's two depths there. Only what is missing is
/// added: where both cover the same columns (e < 0) a ray meets the second if it is not quite parallel to the axis.
template <class Texel>
std::vector<BrickVolume<glm::vec3>> optical_depths(const BasicPyramid<Texel>& pyramid);

}  // namespace voxref
