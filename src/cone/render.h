#pragma once
#include <cstdint>
#include <string>

#include "cone/pixel_shader.h"
#include "image/image.h"
#include "progress.h"

namespace voxref {

/// Side of the regular grid of positions over a pixel whose mean is taken: 4 is as finely as cone tracing, which is
/// smooth over a voxel, can tell; edges keep 16 shades.
constexpr int positions_per_side(PixelSampling pixel) { return pixel == PixelSampling::center ? 1 : 4; }

/// The image stage: primary rays, direct light of the punctual lights, diffuse and specular gathers, emission. Layers
/// of cli.md for `cone`: R,G,B is composed, linear, not tone-mapped; diffuse and specular are as gathered. A pixel
/// whose value is not finite is counted, never painted over.
struct ConeImage {
  Image image;
  uint64_t nonfinite = 0;       ///< pixels with a NaN or an infinity
  std::string first_nonfinite;  ///< "pixel (x, y)", empty when there is none
};
ConeImage render_cones(const LitScene& lit, const View& view, const RenderOptions& options,
                       const Progress& progress = {});

}  // namespace voxref
