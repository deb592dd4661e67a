#include "cone/pixel_shader.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <variant>

#include "cone/clearance.h"

namespace voxref {
namespace {

/// The greatest distance between a light and a point of the box.
float farthest_light(const Scene& scene, const Bounds& box) {
  float farthest = 0.0f;
  for (const Light& light : scene.lights)
    if (light.type != LightType::directional)
      farthest = std::max(
          farthest, glm::length(glm::max(glm::abs(light.position - box.min), glm::abs(light.position - box.max))));
  return farthest;
}

GatherOptions gather_options(const LitScene& lit, const RenderOptions& options, const glm::vec3& background) {
  constexpr float rounding = 1.001f;  // of positions on the scene's bounds
  GatherOptions gather;
  gather.cone = options.cone;
  gather.ao = options.ao;
  gather.shadow_aperture = options.pixel.shadow_cone_aperture;
  gather.shadow_tolerance = options.pixel.shadow_cone_tolerance;
  gather.background = background;
  gather.box = lit.box;
  gather.farthest_light = rounding * farthest_light(lit.scene, lit.scene.bounds());
  return gather;
}

/// How a surface reflects what cones gather.
struct Lobes {
  glm::vec3 diffuse;     ///< factor on irradiance
  glm::vec3 specular;    ///< factor on the mean radiance around the mirror direction
  float tan_half_angle;  ///< of that cone
};

Lobes lobes(const GBufferPoint& point, const PixelOptions& options) {
  const bool phong = options.brdf == PixelBrdf::blinn_phong;
  Lobes lobes;
  if (phong) {
    lobes.diffuse = point.phong.diffuse;
    lobes.specular = point.phong.specular;
  } else {
    // What the specular lobe reflects is taken off the base, so that both send no more than arrives.
    const float n_v = std::clamp(glm::dot(point.normal, point.to_viewer), 0.0f, 1.0f);
    const Reflectance& r = point.reflectance;
    lobes.diffuse = r.has_diffuse() ? diffuse_albedo(r, n_v) : glm::vec3(0.0f);
    lobes.specular = r.has_specular() ? specular_albedo(r, n_v) : glm::vec3(0.0f);
  }
  if (!phong || options.phong.divide_by_pi) lobes.diffuse /= std::numbers::pi_v<float>;
  lobes.tan_half_angle = options.specular_cone == SpecularCone::glossiness
                             ? published_specular_tan_half_angle(point.phong.glossiness)
                             : specular_tan_half_angle(point.reflectance.alpha);
  return lobes;
}

}  // namespace

PixelShader::PixelShader(const LitScene& lit, const RenderOptions& options, const glm::vec3& background)
    : lit_(lit),
      lights_(by_type(lit.scene.lights)),
      options_(options),
      gatherer_(lit.volume, gather_options(lit, options, background)) {}

PixelLight PixelShader::operator()(const GBufferPoint& point) const {
  PixelLight light;
  light.emission = point.emission;
  const GatherPoint from = gather_point(point);
  light.direct = direct(point, from);
  gather(point, from, light);
  const CompositeOptions& composite = options_.composite;
  glm::vec3 indirect = composite.bounce_strength * (light.diffuse + light.specular);
  if (composite.indirect_power != 1.0f) indirect = glm::pow(indirect, glm::vec3(composite.indirect_power));
  light.color = (light.direct + indirect) * light.ao + light.emission;
  return light;
}

// Raw cones start where the published shaders start them, whatever stands near.
GatherPoint PixelShader::gather_point(const GBufferPoint& point) const {
  GatherPoint from{point.position, point.geometric_normal, point.normal};
  if (const std::optional<float> voxel = extinction_voxel(lit_.volume))
    from.aside = clearance(lit_.scene, lit_.caster, point.position, point.geometric_normal, options_.cone, *voxel);
  return from;
}

glm::vec3 PixelShader::direct(const GBufferPoint& point, const GatherPoint& from) const {
  glm::vec3 sum(0.0f);
  const bool phong = options_.pixel.brdf == PixelBrdf::blinn_phong;
  for (const Light& light : lights_) {
    const Illumination lit = illuminate(light, point.position, lit_.light);
    const float cosine = glm::dot(point.normal, lit.to_light);
    if (lit.irradiance == glm::vec3(0.0f) || cosine <= 0.0f || glm::dot(point.geometric_normal, lit.to_light) <= 0.0f)
      continue;
    const glm::vec3 brdf =
        phong ? evaluate(point.phong, point.normal, point.to_viewer, lit.to_light, options_.pixel.phong)
              : evaluate(point.reflectance, point.normal, point.to_viewer, lit.to_light);
    if (brdf != glm::vec3(0.0f)) sum += brdf * cosine * lit.irradiance * visibility(from, light, lit);
  }
  return sum;
}

float PixelShader::visibility(const GatherPoint& from, const Light& light, const Illumination& lit) const {
  switch (options_.pixel.shadow) {
    case PixelShadow::none:
      return 1.0f;
    case PixelShadow::rays: {
      const Caster& caster = lit_.caster;
      const Ray away = caster.leave(from.position, from.geometric_normal, lit.to_light);
      const bool directional = light.type == LightType::directional;
      return (directional ? !caster.occluded(away) : caster.visible(away.origin, light.position)) ? 1.0f : 0.0f;
    }
    case PixelShadow::cone:
      return gatherer_.visibility(from, light, lit);
    case PixelShadow::visibility:
      return (*lit_.visibility)(from.position);
  }
  return 1.0f;
}

void PixelShader::gather(const GBufferPoint& point, const GatherPoint& from, PixelLight& light) const {
  const Lobes lobe = lobes(point, options_.pixel);
  const bool black = lobe.diffuse == glm::vec3(0.0f);
  if (!black || (options_.ao.enabled && !options_.ao.skip_black)) {
    const DiffuseGather gathered = gatherer_.diffuse(from);
    light.diffuse = lobe.diffuse * gathered.irradiance;
    light.ao = gathered.openness;
  }
  if (lobe.specular != glm::vec3(0.0f))
    light.specular = lobe.specular * gatherer_.specular(from, point.to_viewer, lobe.tan_half_angle);
}

}  // namespace voxref
