#include "scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "error.h"
#include "scene/scene.h"

namespace voxref {

namespace {
/// Parallel within a milliradian: the cross product no longer says where "up" is.
constexpr float least_sine = 1e-3f;
}  // namespace

Camera look_at(const glm::vec3& eye, const glm::vec3& target, const glm::vec3& up, float yfov) {
  const glm::vec3 view = target - eye;
  if (!(glm::length(view) > 0.0f)) throw Error("camera", "eye and target coincide");
  if (!(glm::length(up) > 0.0f)) throw Error("camera", "up has no direction");
  const glm::vec3 back = -glm::normalize(view);
  const glm::vec3 side = glm::cross(glm::normalize(up), back);
  if (glm::length(side) < least_sine) throw Error("camera", "up is parallel to the view");
  const glm::vec3 right = glm::normalize(side);
  Camera camera;
  camera.yfov = yfov;
  camera.znear = 1e-3f * glm::length(view);
  camera.world_from_camera = glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::cross(back, right), 0.0f),
                                       glm::vec4(back, 0.0f), glm::vec4(eye, 1.0f));
  return camera;
}

Camera framing_camera(const Scene& scene) {
  const Bounds bounds = scene.bounds();
  const float yfov = glm::radians(45.0f);
  const float radius = std::max(0.5f * glm::length(bounds.extent()), 1e-6f);
  // The bounding sphere touches the frame's upper and lower edge; 1.05 leaves a border.
  const float distance = 1.05f * radius / std::sin(0.5f * yfov);
  const glm::vec3 from = glm::normalize(glm::vec3(0.0f, 0.25f, 1.0f));
  Camera camera = look_at(bounds.center() + distance * from, bounds.center(), {0.0f, 1.0f, 0.0f}, yfov);
  camera.name = "framing";
  return camera;
}

RayGenerator::RayGenerator(const View& view)
    : eye_(view.camera.world_from_camera[3]),
      forward_(-glm::normalize(glm::vec3(view.camera.world_from_camera[2]))),
      scale_(2.0f / glm::vec2(view.width, view.height)),
      orthographic_(view.camera.orthographic) {
  const float half_height = orthographic_ ? view.camera.ymag : std::tan(0.5f * view.camera.yfov);
  const float half_width = half_height * static_cast<float>(view.width) / static_cast<float>(view.height);
  right_ = half_width * glm::normalize(glm::vec3(view.camera.world_from_camera[0]));
  up_ = half_height * glm::normalize(glm::vec3(view.camera.world_from_camera[1]));
}

Ray RayGenerator::operator()(const glm::vec2& position) const {
  const glm::vec2 ndc = glm::vec2(position.x * scale_.x - 1.0f, 1.0f - position.y * scale_.y);
  const glm::vec3 offset = ndc.x * right_ + ndc.y * up_;
  return orthographic_ ? Ray{eye_ + offset, forward_} : Ray{eye_, glm::normalize(forward_ + offset)};
}

}  // namespace voxref
