#pragma once
#include <span>

namespace voxref {

/// Mean structural similarity, Wang, Bovik, Sheikh and Simoncelli 2004: 11x11 Gaussian window of sigma 1.5, K1 = 0.01,
/// K2 = 0.03, dynamic range 1. The mean is over the windows that lie inside the picture; along a side shorter than 11
/// the window has that many taps, one less where that is even.
/// @param a, b planes [y][x] of width x height values in [0,1] @return in [-1,1], 1 for equal planes
double ssim(int width, int height, std::span<const float> a, std::span<const float> b);

}  // namespace voxref
