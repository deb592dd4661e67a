#pragma once
#include <string>

#include "image/image.h"

namespace voxref {

/// How far a cone-traced image is from the path-traced one, the path tracer's own noise taken out (cli.md).
/// d = cone - path and s = the standard error, both as luminance over all pixels.
struct Metrics {
  bool indirect_only = false;  ///< whether the first three are of the indirect light (all lights punctual) or of R,G,B
  double mean_ratio = 0;       ///< mean(cone) / mean(path)
  double rel_error = 0;        ///< sqrt(max(0, mean(d^2) - mean(s^2))) / mean(path)
  double noise_share = 0;      ///< mean(s^2) / mean(d^2)
  double rmse = 0;             ///< over R,G,B, radiance
  double relmse = 0;           ///< mean((a-b)^2 / (b^2 + 0.01)) over pixels and channels of R,G,B
  double psnr = 0;             ///< dB, of the pictures as displayed (clipped, sRGB), peak 1
  double ssim = 0;             ///< of the same pictures' luma, Wang et al. 2004, 11x11 Gaussian of sigma 1.5
  double flip = 0;             ///< mean LDR-FLIP of the same pictures, Andersson et al. 2020, 67 pixels per degree
  static constexpr const char* relmse_formula = "mean((a-b)^2 / (b^2 + 0.01))";
};

/// @param cone layers "", diffuse, specular @param path layers "", indirect, channels stderr.Y and stderr.indirect.Y
/// @param exposure stops, for the displayed pictures
/// @throws Error when the sizes differ or a layer is missing
Metrics compare(const Image& cone, const Image& path, bool indirect_only, float exposure);

/// Stops that bring the 99th percentile of the image's luminance to 0.9; 0 for a black image.
float auto_exposure(const Image& image);

}  // namespace voxref
