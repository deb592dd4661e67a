#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "image/image.h"

namespace voxref {

/// How far a cone-traced image is from the path-traced one, the path tracer's own noise taken out (cli.md).
/// d = cone - path and s = the standard error, both as luminance over all pixels.
///
/// A value that does not exist is NaN: all of them where a compared pixel is NaN or infinite (`nonfinite_cone`,
/// `nonfinite_path` count such pixels), `mean_ratio` over a black path-traced image, `noise_share` of equal images.
struct Metrics {
  bool indirect_only = false;   ///< whether the first three are of the indirect light (all lights punctual) or of R,G,B
  double mean_ratio = 0;        ///< mean(cone) / mean(path)
  double rel_error = 0;         ///< sqrt(max(0, mean(d^2) - mean(s^2))) / mean(path); 0 where the root is 0
  double noise_share = 0;       ///< mean(s^2) / mean(d^2)
  double rmse = 0;              ///< over R,G,B, radiance
  double relmse = 0;            ///< mean((a-b)^2 / (b^2 + 0.01)) over pixels and channels of R,G,B
  double psnr = 0;              ///< dB, of the pictures as displayed (clipped, sRGB), peak 1; infinite when equal
  double ssim = 0;              ///< of the same pictures' luma, see ssim.h
  double flip = 0;              ///< mean LDR-FLIP of the same pictures, see flip.h
  uint64_t nonfinite_cone = 0;  ///< compared pixels with a NaN or an infinity
  uint64_t nonfinite_path = 0;  ///< the same of the other side, its standard error included
  std::string first_nonfinite;  ///< "cone pixel (x, y)" or "path pixel (x, y)"; empty when there is none
  static constexpr const char* relmse_formula = "mean((a-b)^2 / (b^2 + 0.01))";
};

/// @param cone layers "", diffuse, specular @param path layers "", indirect, channels stderr.Y and stderr.indirect.Y;
///        of the standard errors and indirect layers only what `indirect_only` calls for is needed
/// @param exposure stops, for the displayed pictures
/// @throws Error when the sizes differ or a layer is missing
Metrics compare(const Image& cone, const Image& path, bool indirect_only, float exposure);

/// The keys of cli.md, plus `of` ("indirect" or "rgb"), `nonfinite_cone`, `nonfinite_path` and `first_nonfinite`. JSON
/// knows neither NaN nor infinity: both are null, so `psnr` of equal pictures is.
nlohmann::json to_json(const Metrics& metrics);

/// Stops that bring the 99th percentile of the image's luminance to 0.9; 0 for a black image. Pixels that are not
/// finite do not count.
float auto_exposure(const Image& image);

}  // namespace voxref
