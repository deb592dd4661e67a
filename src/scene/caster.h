#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "scene/ray.h"
#include "scene/scene.h"

namespace voxref {

/// Which surfaces rays hit.
struct CasterOptions {
  bool cull_back_faces = false;        ///< rays pass clockwise triangles, double-sided ones too
  std::optional<float> discard_alpha;  ///< rays pass where alpha is at most this, whatever the material says of masks
};

/// Finds what rays hit, over a scene's triangles; holes of alpha-masked materials let them through. Immutable after
/// construction, so any number of threads may cast at once. Keeps a reference to the scene.
class Caster {
 public:
  explicit Caster(const Scene& scene, const CasterOptions& options = {});
  ~Caster();
  Caster(Caster&&) noexcept;
  Caster(const Caster&) = delete;

  /// The nearest hit with t in [ray.tmin, ray.tmax], or none.
  Hit closest(const Ray& ray) const;
  /// Whether anything lies between ray.tmin and ray.tmax.
  bool occluded(const Ray& ray) const;

  /// The same for many rays, which are cast in packets: fastest where neighbours in the list have much of their way in
  /// common. @param hits,blocked as many as rays; each ray's answer stands in its place, for `blocked` as 0 or 1
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  void occluded(std::span<const Ray> rays, std::span<uint8_t> blocked) const;

  /// How far a ray's origin must stand off its surface, along the normal, so that rounding cannot put it behind: 32
  /// units in the last place of the scene's largest coordinate. World units.
  float surface_offset() const;

  /// Where a ray that leaves a surface at `point` to the side of `normal` (unit) begins.
  glm::vec3 beside(const glm::vec3& point, const glm::vec3& normal) const { return point + surface_offset() * normal; }
  Ray leave(const glm::vec3& point, const glm::vec3& normal, const glm::vec3& direction) const {
    return {beside(point, normal), direction, 0.0f, std::numeric_limits<float>::infinity()};
  }
  /// The open segment between two points, each of which must already stand off its surface.
  static Ray segment(const glm::vec3& from, const glm::vec3& to) { return {from, to - from, 0.0f, 1.0f}; }
  bool visible(const glm::vec3& from, const glm::vec3& to) const { return !occluded(segment(from, to)); }

  /// Bytes that the acceleration structure holds.
  size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace voxref
