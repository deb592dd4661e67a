#pragma once
#include <span>
#include <vector>

#include "image/image.h"
#include "progress.h"
#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

/// The light that studies compare, as luminance per pixel, with the standard error of each (0: exact).
struct Measured {
  std::vector<double> value, standard_error;
  double mean() const;
};

/// Light that `check` compares (cli.md): indirect, where all lights are punctual, else all.
bool compares_indirect(const Scene& scene, const View& view);
/// @param cone,path as render_cones and path_trace return them
Measured measured_cone(const Image& cone, bool indirect);
Measured measured_path(const Image& path, bool indirect);

/// How far one is from the other.
struct Deviation {
  double bias = 0;             ///< mean(a) / mean(b) - 1
  double rel_error = 0;        ///< of cli.md: RMS of a - b over mean(b), the noise of both taken out
  double rel_error_error = 0;  ///< its standard error, from that noise
};
/// With d = a - b and s^2 the sum of both squared standard errors, rel_error = sqrt(mean(d^2) - mean(s^2)) / mean(b),
/// at least 0. Noise moves mean(d^2) by sum 2 d s / n, thus rel_error by sqrt(sum d^2 s^2) / (n sqrt(mean(d^2))
/// mean(b)). All NaN where b is black.
Deviation deviation(const Measured& a, const Measured& b);

}  // namespace voxref
