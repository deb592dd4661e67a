#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "image/image.h"

namespace voxref {

/// How far two pictures differ as a display shows them: radiance x 2^exposure, clipped to [0,1], sRGB.
struct DisplayedDifference {
  double psnr = 0.0;  ///< dB, over R,G,B, peak 1; infinite when equal
  double ssim = 0.0;  ///< of the pictures' luma, see ssim.h
  double flip = 0.0;  ///< mean LDR-FLIP, see flip.h
};

/// @param a the one under test @param b the reference; both finite, of equal size, with R,G,B
DisplayedDifference displayed_difference(const Image& a, const Image& b, float exposure);
/// psnr alone, which takes a hundredth of the time.
double displayed_psnr(const Image& a, const Image& b, float exposure);

/// Layer "" as linear colours, one per pixel.
std::vector<glm::vec3> colors(const Image& image);

}  // namespace voxref
