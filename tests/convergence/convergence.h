#pragma once
#include <cmath>
#include <string>

#include "compare/metrics.h"
#include "pipeline.h"
#include "reference/path.h"

namespace voxref {

/// One rung of a ladder of settings.
struct Rung {
  int resolution = 64, cones = 16;
  float step = 0.5f;
  int bounce_cones = 6;
};

/// How far the cone tracer's indirect light is from the path tracer's.
struct Distance {
  double mean_ratio = 0.0;
  double rel_error = 0.0;  ///< cli.md
  double error_bar = 0.0;  ///< one standard error of rel_error, from the path tracer's noise
};

inline View square_view(const Scene& scene, int size) {
  View view;
  view.camera = scene.cameras.at(0);
  view.width = view.height = size;
  return view;
}

/// Path-traced, with `bounces` scatterings after the first that count as indirect.
inline Image indirect_reference(const Scene& scene, const View& view, int bounces, int spp) {
  const Caster caster(scene);
  PathOptions options;
  options.spp = spp;
  options.max_depth = bounces + 2;
  return path_trace(scene, caster, view, options).image;
}

/// With d = cone - path, and s the standard error of path, rel_error = sqrt(mean(d^2) - mean(s^2)) / mean(path); noise
/// moves mean(d^2) by sum 2 d s / n, thus rel_error by sqrt(sum d^2 s^2) / (n sqrt(mean(d^2)) mean(path)).
inline Distance distance(const Image& cone, const Image& path) {
  const Metrics metrics = compare(cone, path, /*indirect_only=*/true, 0.0f);
  const auto diffuse = cone.layer("diffuse"), specular = cone.layer("specular"), indirect = path.layer("indirect");
  const auto noise = path.channel("stderr.indirect.Y");
  double mean = 0.0, square = 0.0, variance = 0.0;
  const size_t count = path.pixel_count();
  for (size_t i = 0; i < count; ++i) {
    const auto at = [i](const auto& planes) { return double(luminance({planes[0][i], planes[1][i], planes[2][i]})); };
    const double d = at(diffuse) + at(specular) - at(indirect), s = noise[i];
    mean += at(indirect) / double(count);
    square += d * d / double(count);
    variance += d * d * s * s;
  }
  return {metrics.mean_ratio, metrics.rel_error, std::sqrt(variance / square) / double(count) / mean};
}

inline Distance distance_at(const Rung& rung, const Scene& scene, const View& view, int bounces, const Image& path) {
  const Caster caster(scene);
  Settings settings = profile("radiometric");
  settings.grid.resolution = rung.resolution;
  settings.render.cone.diffuse = rung.cones;
  settings.render.cone.step = rung.step;
  settings.bounce.count = bounces;
  settings.bounce.cones = rung.bounce_cones;
  return distance(cone_trace(scene, caster, view, settings).image.image, path);
}

}  // namespace voxref
