#pragma once
#include <cstdint>
#include <string>

#include "cone/gather.h"
#include "image/image.h"
#include "progress.h"
#include "scene/caster.h"
#include "scene/scene.h"

namespace voxref {

enum class PixelShadow : uint8_t {
  none,
  rays,       ///< to the triangles
  cone,       ///< a cone to the light through the voxels
  visibility  ///< what the voxels see of the lights, interpolated
};

struct PixelOptions {
  PixelShadow shadow = PixelShadow::rays;
  float shadow_cone_aperture = 0.03f;  ///< tangent of the half-angle
  float shadow_cone_tolerance = 0.1f;  ///< t: raw shadow cones multiply opacity by 2^(7 t)
};

/// How the layers become R,G,B: (direct + (bounce_strength (diffuse + specular))^indirect_power) ao + emission.
struct CompositeOptions {
  float bounce_strength = 1.0f;
  float indirect_power = 1.0f;
};

struct RenderOptions {
  ConeOptions cone;
  AoOptions ao;
  PixelOptions pixel;
  CompositeOptions composite;
};

/// The image stage: primary rays, direct light of the punctual lights, diffuse and specular gathers, emission; linear
/// radiance. Layers of cli.md for `cone`. A pixel whose value is not finite is counted, never painted over.
struct ConeImage {
  Image image;
  uint64_t nonfinite = 0;       ///< pixels with a NaN or an infinity
  std::string first_nonfinite;  ///< "pixel (x, y)", empty when there is none
};
ConeImage render_cones(const Scene& scene, const Caster& caster, const Medium& medium, const View& view,
                       const RenderOptions& options, const Progress& progress = {});

}  // namespace voxref
