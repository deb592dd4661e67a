#pragma once
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/causes.h"
#include "compare/difference.h"
#include "compare/displayed.h"
#include "compare/hdr_flip.h"
#include "compare/noise_verdict.h"
#include "image/image.h"
#include "progress.h"

namespace voxref {

/// What makes two images count as different.
struct ImageLimits {
  std::optional<Tolerance> tolerance;  ///< of each value; none: the usual one, and statistics where there is noise
  double fraction = 0.0;               ///< of the values that may be over the tolerance
  std::optional<double> rmse, relmse, flip, hdr_flip;  ///< at most
  std::optional<double> psnr, ssim;                    ///< at least
  NoiseOptions noise;

  /// Whether metrics decide: then values do so only where a tolerance was given too.
  bool by_metrics() const { return rmse || relmse || flip || hdr_flip || psnr || ssim; }
};

struct ImageDiffOptions {
  ImageLimits limits{};
  bool perceptual = true;           ///< SSIM, both FLIPs and Yee, which take nearly all of the time
  std::optional<float> exposure{};  ///< stops, for what is shown; none: auto_exposure of the reference
};

/// Metrics that imitate an eye. Each is of the pictures as shown but for hdr_flip.
struct PerceptualDifference {
  DisplayedDifference displayed;
  double hdr_flip = 0.0;  ///< mean
  FlipExposures exposures;
  uint64_t yee_pixels = 0;  ///< that an observer could tell apart: Yee 2004, 100 cd/m^2, 45 degrees, by OpenImageIO
};

/// Standard errors that are NaN or infinite.
struct NonfiniteErrors {
  uint64_t a = 0, b = 0;
  std::string first;  ///< "A pixel (x, y) stderr.R: nan"; empty: there is none
};

struct ImageDiff {
  Verdict verdict = Verdict::same;
  std::vector<std::string> reasons;  ///< for a verdict that is not `same`, each a sentence
  Tolerance tolerance;
  Difference all;                      ///< over R,G,B
  std::array<Difference, 3> channels;  ///< R, G, B
  Difference luminance;
  NonfiniteErrors errors;
  std::optional<NoiseVerdict>
      noise;               ///< where a side carries standard errors, all is finite, and no tolerance was given
  bool same_seed = false;  ///< both were rendered with one seed: no independent estimates, statistics mislead
  float exposure = 0.0f;
  double psnr = 0.0;  ///< NaN where a value is not finite, as all that `perceptual` holds
  std::optional<PerceptualDifference> perceptual;
  std::vector<Cause> causes;  ///< searched where the verdict is `different` and all is finite

  bool all_finite() const { return all.nonfinite == 0 && errors.a + errors.b == 0; }
};

/// Compares R,G,B of an image under test with that of a reference.
///
/// A value or a standard error that is NaN or infinite on either side makes them different. Else they are `same` when
/// all values but the allowed fraction agree within the tolerance; else, where a side has noise and no tolerance was
/// asked for, statistics decide (noise_verdict.h); else they are `different`. Metrics with a limit decide in place of
/// values.
/// @param a under test @param b reference; see select_layer.h
/// @throws Error when the sizes differ; Interrupted
ImageDiff diff_images(const Image& a, const Image& b, const ImageDiffOptions& options, const Progress& progress = {});

/// The keys of cli.md for `diff`, and more.
nlohmann::json to_json(const ImageDiff& diff);

}  // namespace voxref
