#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "scene/caster.h"
#include "scene/phong_material.h"
#include "scene/surface.h"

namespace voxref {

enum class NormalFormat : uint8_t {
  float32,
  float16  ///< half floats, cut off rather than rounded
};
enum class ColorFormat : uint8_t {
  float32,
  unorm8  ///< bytes: clamped to 1, emission too
};
enum class DepthFormat : uint8_t {
  float32,
  unorm24  ///< between the camera's near and far plane; the position is computed from it
};

/// What a rasterizer keeps of the surfaces that it sees, as far as that changes the picture.
struct GBufferOptions {
  bool cull_back_faces = false;        ///< whatever the material's doubleSided says
  std::optional<float> discard_alpha;  ///< what has at most this alpha is not there; none: the material's own mask
  bool decode_textures = true;         ///< false: sRGB texels are taken as they are (Phong materials)
  bool geometric_normal = true;  ///< bounds what shading normals do; false: they are neither bent nor held against it
  NormalFormat normal = NormalFormat::float32;
  ColorFormat color = ColorFormat::float32;
  DepthFormat depth = DepthFormat::float32;
};

/// The surface that is seen at a position of the image.
struct GBufferPoint {
  glm::vec3 position{0.0f};          ///< world
  glm::vec3 to_viewer{0.0f};         ///< unit
  glm::vec3 geometric_normal{0.0f};  ///< unit; the shading normal where that is all there is
  glm::vec3 normal{0.0f};            ///< unit, shading
  glm::vec3 emission{0.0f};          ///< radiance towards the viewer
  Reflectance reflectance;           ///< for GGX
  PhongMaterial phong;               ///< for Blinn-Phong
  float depth = 0.0f;                ///< along the view axis, world units
};

/// Primary visibility: finds what is seen by casting rays, and rounds it as a G-buffer would (spec section 7).
class GBuffer {
 public:
  /// @throws Error where depth is to be stored in bits and the camera's planes are not 0 < near < far
  GBuffer(const Scene& scene, const Caster& caster, const View& view, const GBufferOptions& options);

  /// @param position in pixels, as RayGenerator's; none where nothing is seen
  std::optional<GBufferPoint> operator()(const glm::vec2& position) const;

 private:
  /// Depth as a G-buffer of 24 bits gives it back.
  float quantized_depth(float depth) const;

  const Scene& scene_;
  GBufferOptions options_;
  Camera camera_;
  std::optional<Caster> own_caster_;  // where it sees other surfaces than shadow rays do
  const Caster& caster_;
  Surfaces surfaces_;
  RayGenerator rays_;
};

}  // namespace voxref
