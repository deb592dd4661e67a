#pragma once
#include <cstdint>
#include <optional>

#include "cone/blinn_phong.h"
#include "cone/gatherer.h"
#include "cone/gbuffer.h"
#include "cone/light_visibility.h"

namespace voxref {

enum class PixelShadow : uint8_t {
  none,
  rays,       ///< to the triangles
  cone,       ///< a cone to the light through the voxels
  visibility  ///< what the voxels see of the lights, interpolated
};
enum class PixelBrdf : uint8_t {
  ggx,          ///< glTF 2.0's metallic-roughness and specular-glossiness
  blinn_phong,  ///< the published shaders', of spec section 7
};
enum class SpecularCone : uint8_t {
  ggx,        ///< half-angle fitted to the lobe
  glossiness  ///< the published shaders' tangent of (1 - s) x 90 degrees
};

struct PixelOptions {
  PixelBrdf brdf = PixelBrdf::ggx;
  BlinnPhongOptions phong;
  SpecularCone specular_cone = SpecularCone::ggx;
  PixelShadow shadow = PixelShadow::rays;
  float shadow_cone_aperture = 0.03f;  ///< tangent of the half-angle
  float shadow_cone_tolerance = 0.1f;  ///< t: raw shadow cones multiply opacity by 2^(7 t); 1: any opacity is black
};

/// How the layers become R,G,B: (direct + (bounce_strength (diffuse + specular))^indirect_power) ao + emission.
struct CompositeOptions {
  float bounce_strength = 1.0f;
  float indirect_power = 1.0f;
};

struct RenderOptions {
  ConeOptions cone;
  AoOptions ao;
  GBufferOptions gbuffer;
  PixelOptions pixel;
  CompositeOptions composite;
};

/// Everything that cones and shadows of an image read.
struct LitScene {
  const Scene& scene;
  const Caster& caster;  ///< for shadow rays
  const LitVolume& volume;
  Bounds box;                                   ///< that raw cones must meet
  LightOptions light;                           ///< how the lights fade
  const LightVisibility* visibility = nullptr;  ///< null unless pixel.shadow asks for it
};

/// Light from a surface towards its viewer, W/(sr m^2).
struct PixelLight {
  glm::vec3 color{0.0f};  ///< composed
  glm::vec3 direct{0.0f}, diffuse{0.0f}, specular{0.0f}, emission{0.0f};
  float ao = 1.0f;
};

/// Shades points of the G-buffer: direct light of the punctual lights, light gathered by cones, and their composition
/// (spec section 7).
class PixelShader {
 public:
  /// Keeps references to what `lit` refers to.
  PixelShader(const LitScene& lit, const RenderOptions& options, const glm::vec3& background);

  PixelLight operator()(const GBufferPoint& point) const;

 private:
  glm::vec3 direct(const GBufferPoint& point, const GatherPoint& from) const;
  float visibility(const GatherPoint& from, const Light& light, const Illumination& lit) const;
  void gather(const GBufferPoint& point, const GatherPoint& from, PixelLight& light) const;
  /// Where the point's cones start.
  GatherPoint gather_point(const GBufferPoint& point) const;

  LitScene lit_;
  std::vector<Light> lights_;
  RenderOptions options_;
  Gatherer gatherer_;
};

}  // namespace voxref
