#pragma once
#include "voxel/array_layout.h"
#include "voxel/binary_file.h"

namespace voxref {

/// A headerless array: X.raw, described by the JSON object in X.raw.json beside it.
///
///   "dims"         [nx, ny, nz], or [nx, ny] of an image
///   "format"       a name of texel_format.h
///   "axis_order"   the axes from slowest to fastest; default "zyxc"; x, y, z in any order, c (channels) last
///   "flip"         array of the axes that run backwards in the file: ["y"] where row 0 is the bottom one; default none
///   "row_pitch"    bytes from one row (the fastest of x, y, z) to the next; default: no gaps
///   "slice_pitch"  bytes from one slice (the two fastest) to the next; default: no gaps
///   "offset"       bytes before the first texel; default 0
///
/// The file ends with the last texel, or with the gap after its row, or after its slice.
/// @throws Error `FILE: PLACE: what is wrong`
ArrayLayout raw_layout(BinaryFile& file);

}  // namespace voxref
