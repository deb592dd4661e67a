#pragma once
#include "voxel/array_layout.h"
#include "voxel/binary_file.h"

namespace voxref {

/// One mip level of a DirectDraw Surface: a 2D texture or a volume texture, uncompressed, as RenderDoc saves it. The
/// format is named by the DX10 header, or by bit masks where there is none: RenderDoc writes those for r8g8b8a8_unorm
/// and r8_unorm. Slices and rows follow each other without gaps; all slices of a level, then the next level, whose
/// sides are half, rounded down, at least 1. Source: Microsoft, "Programming Guide for DDS", "DDS_HEADER",
/// "DDS_PIXELFORMAT", "DDS_HEADER_DXT10 structure", "DDS Volume Texture Example".
/// @throws Error `FILE: PLACE: what is wrong`: a malformed header, a format that is not in texel_format.h, a cube or an
/// array of textures, no such mip level, a length that is not what the header asks for
ArrayLayout dds_layout(BinaryFile& file, int mip);

}  // namespace voxref
