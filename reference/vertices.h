#pragma once
#include <cstdint>

#include "reference/bsdf.h"
#include "reference/lanes.h"
#include "reference/light_tree.h"

namespace voxref {

/// Points at which paths scatter light, side by side.
class Vertices {
 public:
  void clear() {
    size_ = 0;
    lambertian_ = true;
  }
  /// @param to_previous unit, towards the path's vertex before
  void add(const SurfacePoint& point, const glm::vec3& to_previous);
  size_t size() const { return size_; }

  const Lanes3& positions() const { return position_; }
  const Lanes3& geometric_normals() const { return geometric_normal_; }
  Receiver receiver(size_t i) const { return {position_[i], normal_[i]}; }

  /// Bsdf::value and Bsdf::pdf of a direction at each vertex.
  void evaluate(const Lanes3& in, Lanes3& value, Lanes<float>& pdf) const;
  /// Bsdf::sample at each vertex. @param choice,x,y random bits
  void sample(const uint32_t* choice, const uint32_t* x, const uint32_t* y, Lanes3& in, Lanes3& weight,
              Lanes<float>& pdf) const;

 private:
  Bsdf bsdf(size_t i, bool lambertian) const;

  size_t size_ = 0;
  bool lambertian_ = true;  // all of them: what the others need is then not even there
  Lanes3 position_, geometric_normal_, normal_, out_, diffuse_, specular_f0_, specular_f1_;
  Lanes<float> layer_f0_, layer_f1_, alpha_, specular_share_;
};

}  // namespace voxref
