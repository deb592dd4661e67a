#pragma once
#include "compare/image_diff.h"

namespace voxref {

/// Fills in verdict and reasons of a difference whose values and metrics are there, and `noise` where statistics
/// decide.
void judge_images(ImageDiff& diff, const Image& a, const Image& b, const ImageLimits& limits);

}  // namespace voxref
