#pragma once
#include <filesystem>
#include <vector>

#include "compare/causes.h"
#include "compare/volume_diff.h"
#include "progress.h"

namespace voxref {

/// The largest volume whose mistakes are searched, texels: both sides are held in memory for it.
inline constexpr size_t most_searched_texels = size_t{256} * 256 * 256;

/// Why two folders of volumes differ: faces in another order, mip levels named one off, else the classic mistakes in
/// the first volume that differs. Empty where none explains it, or that volume is larger than most_searched_texels.
/// @param a under test @param b reference, with the same grid
std::vector<Cause> volume_causes(const std::filesystem::path& a, const std::filesystem::path& b,
                                 const FolderDifference& folder, const Progress& progress = {});

/// The same for two single volumes.
std::vector<Cause> volume_causes(ArrayFile& a, ArrayFile& b, const Tolerance& tolerance, const Progress& progress = {});

}  // namespace voxref
