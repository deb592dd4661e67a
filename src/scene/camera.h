#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <string>

#include "scene/ray.h"

namespace voxref {

struct Scene;

/// A glTF camera: looks along -Z of its own frame, +Y up.
struct Camera {
  std::string name;
  glm::mat4 world_from_camera{1.0f};  ///< rotation and translation; no scale
  bool orthographic = false;
  float yfov = 0.8f;           ///< radians, perspective
  float ymag = 1.0f;           ///< half height in world units, orthographic
  float aspect = 4.0f / 3.0f;  ///< width / height, used where no image size is given
  /// Distances along the view axis, world units; only an image whose depth is stored in bits is cut off at them. None
  /// where the file gives no far plane.
  float znear = 0.01f, zfar = std::numeric_limits<float>::infinity();
};

/// A camera at `eye` that looks at `target`, its near plane at a thousandth of the way. @throws Error when they
/// coincide or `up` is parallel to the view
Camera look_at(const glm::vec3& eye, const glm::vec3& target, const glm::vec3& up, float yfov);

/// A camera that frames the whole scene from the front (+Z), slightly above; also for a scene without triangles.
Camera framing_camera(const Scene& scene);

enum class PixelSampling : uint8_t {
  center,  ///< one position per pixel, its centre, as a GPU renders without anti-aliasing
  box      ///< the pixel's mean
};

/// What both renderers are asked for: the same camera, size, sampling and surroundings.
struct View {
  Camera camera;
  int width = 512, height = 512;
  PixelSampling pixel = PixelSampling::center;
  glm::vec3 background{0.0f};  ///< constant radiance from outside, W/(sr m^2)
};

/// Turns image positions into rays; holds what does not change over an image.
class RayGenerator {
 public:
  explicit RayGenerator(const View& view);
  /// @param position in pixels, (0,0) the image's upper left corner, pixel (x,y) centred at (x + 0.5, y + 0.5)
  /// Direction is unit. The near plane is ignored.
  Ray operator()(const glm::vec2& position) const;
  glm::vec3 forward() const { return forward_; }  ///< unit; depth Z = dot(point - eye, forward)
  glm::vec3 eye() const { return eye_; }

 private:
  glm::vec3 eye_, forward_, right_, up_;  // right_ and up_ span half the image's extent (at distance 1 in perspective)
  glm::vec2 scale_;
  bool orthographic_;
};

}  // namespace voxref
