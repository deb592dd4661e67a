#include "cone/gbuffer.h"

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "error.h"

namespace voxref {
namespace {

/// The half float between 0 and x that is nearest to x, for |x| in [0, 1]: ten bits of mantissa are kept, below 2^-14
/// (half's denormal numbers) steps of 2^-24.
float cut_to_half(float x) {
  constexpr float least_normal = 0x1p-14f, denormal_step = 0x1p-24f;
  if (std::abs(x) < least_normal) return std::trunc(x / denormal_step) * denormal_step;
  return std::bit_cast<float>(std::bit_cast<uint32_t>(x) & 0xffffe000u);
}
glm::vec3 cut_to_half(const glm::vec3& v) { return {cut_to_half(v.x), cut_to_half(v.y), cut_to_half(v.z)}; }

/// Stored in a byte, to nearest even, and decoded by a multiplication as GPUs do.
float in_byte(float x) { return std::nearbyint(glm::clamp(x, 0.0f, 1.0f) * 255.0f) * (1.0f / 255.0f); }
glm::vec3 in_bytes(const glm::vec3& v) { return {in_byte(v.x), in_byte(v.y), in_byte(v.z)}; }

bool needs_own_caster(const GBufferOptions& options) { return options.cull_back_faces || options.discard_alpha; }

}  // namespace

GBuffer::GBuffer(const Scene& scene, const Caster& caster, const View& view, const GBufferOptions& options)
    : scene_(scene),
      options_(options),
      camera_(view.camera),
      own_caster_(needs_own_caster(options)
                      ? std::optional<Caster>(std::in_place, scene,
                                              CasterOptions{options.cull_back_faces, options.discard_alpha})
                      : std::nullopt),
      caster_(own_caster_ ? *own_caster_ : caster),
      surfaces_(scene),
      rays_(view) {
  const bool planes =
      camera_.znear < camera_.zfar && (camera_.orthographic ? std::isfinite(camera_.zfar) : camera_.znear > 0.0f);
  if (options.depth == DepthFormat::unorm24 && !planes)
    throw Error("camera '" + camera_.name + "'", "gbuffer.depth=unorm24 needs a near plane before a far plane");
}

// Perspective depth in [0,1] is (1 - n/z) / k with k = 1 - n/f; orthographic (z - n) / (f - n).
float GBuffer::quantized_depth(float depth) const {
  constexpr double most = (1 << 24) - 1;
  const auto stored = [](double d) { return std::nearbyint(glm::clamp(d, 0.0, 1.0) * most) / most; };
  const double n = camera_.znear, f = camera_.zfar;
  if (camera_.orthographic) return static_cast<float>(n + stored((depth - n) / (f - n)) * (f - n));
  const double k = 1.0 - n / f;
  return static_cast<float>(n / (1.0 - stored((1.0 - n / depth) / k) * k));
}

std::optional<GBufferPoint> GBuffer::operator()(const glm::vec2& position) const {
  Ray ray = rays_(position);
  const float along = glm::dot(ray.direction, rays_.forward());
  const bool stored_depth = options_.depth == DepthFormat::unorm24;
  if (stored_depth) {
    ray.tmin = camera_.znear / along;
    ray.tmax = camera_.zfar / along;
  }
  const Hit hit = caster_.closest(ray);
  if (!hit) return std::nullopt;

  const glm::vec3 to_viewer = -glm::normalize(ray.direction);
  const SurfacePoint surface = surfaces_.point(hit, to_viewer);
  GBufferPoint point;
  point.position = surface.position;
  point.to_viewer = to_viewer;
  point.depth = glm::dot(surface.position - rays_.eye(), rays_.forward());
  point.geometric_normal = surface.geometric_normal;
  point.normal = options_.geometric_normal ? surface.shading_normal : surface.stored_normal;
  point.emission = surface.emission;
  point.reflectance = surface.reflectance;
  point.phong = phong_material(scene_, hit.triangle, hit.uv, options_.decode_textures);
  point.phong.glossiness = std::max(point.phong.glossiness, 0.01f);  // spec section 7
  if (!options_.decode_textures && surface.emission != glm::vec3(0.0f)) point.emission = point.phong.emission;

  if (stored_depth) {
    point.depth = quantized_depth(point.depth);
    point.position = ray.origin + (point.depth / along) * ray.direction;
  }
  if (options_.normal == NormalFormat::float16) point.normal = glm::normalize(cut_to_half(point.normal));
  if (!options_.geometric_normal) point.geometric_normal = point.normal;
  if (options_.color == ColorFormat::unorm8) {
    point.emission = in_bytes(point.emission);
    point.reflectance.diffuse = in_bytes(point.reflectance.diffuse);
    point.reflectance.specular_f0 = in_bytes(point.reflectance.specular_f0);
    point.phong.diffuse = in_bytes(point.phong.diffuse);
    point.phong.specular = in_bytes(point.phong.specular);
    point.phong.glossiness = in_byte(point.phong.glossiness);
  }
  return point;
}

}  // namespace voxref
