#pragma once
#include <vector>

#include "image/image.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace voxref {

/// The light that is compared, as luminance per pixel, with the standard error of each (0: exact).
struct Measured {
  std::vector<double> value, standard_error;
  double mean() const;
};

/// Whether the indirect light is compared, where all lights are punctual, or else all of it (cli.md).
bool compares_indirect(const Scene& scene, const View& view);

/// @param cone as render_cones returns it @throws Error when a layer is missing
Measured measured_cone(const Image& cone, bool indirect);
/// @param path as path_trace returns it @throws Error when a layer or its standard errors are missing
Measured measured_path(const Image& path, bool indirect);

}  // namespace voxref
