#pragma once
#include <filesystem>
#include <functional>
#include <span>

#include "voxel/array_file.h"

namespace voxref {

/// NumPy's array files (NEP 1, format versions 1 to 3), little-endian, in C order: the last index is fastest.
/// @throws Error with the path: not an array file, Fortran order, another type than ElementType's, less than two or
/// more than four sides, a side of 0, or a length that is not what shape and type ask for
ArrayLayout npy_layout(BinaryFile& file, ArrayMeaning meaning);

/// Calls fill(i, slice) for each index of the first dimension in turn, `slice` zeroed and of the product of the other
/// dimensions, so that a large array is never in memory as a whole. Values are converted as encode_elements does. The
/// file appears whole or not at all. @throws Error with the path when it cannot be written
void write_npy(const std::filesystem::path& file, ElementType type, std::span<const size_t> shape,
               const std::function<void(size_t i, std::span<float> slice)>& fill);

}  // namespace voxref
