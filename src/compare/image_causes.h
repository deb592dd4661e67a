#pragma once
#include <vector>

#include "compare/causes.h"
#include "compare/image_diff.h"

namespace voxref {

/// Why two finite images differ, as `diff` found that they do. Under noise a mistake explains it where, once undone,
/// statistics find no difference any more; errors of the image under test are carried along.
std::vector<Cause> image_causes(const ImageDiff& diff, const Image& a, const Image& b, const NoiseOptions& options,
                                const Progress& progress = {});

}  // namespace voxref
