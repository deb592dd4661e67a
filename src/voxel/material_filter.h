#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "scene/scene.h"
#include "voxel/clip.h"

namespace voxref {

/// A material's means over a piece of a triangle.
struct FilteredMaterial {
  double coverage = 1.0;     ///< share of the piece's area that is no hole of an alpha mask, in [0,1]
  glm::dvec3 albedo{0.0};    ///< over what is covered, in [0,1]
  glm::dvec3 emission{0.0};  ///< over what is covered, radiance, W/(sr m^2)
};

/// Filters materials to the footprint of a piece. A material without textures on a scene without vertex colours is
/// evaluated once; the others at points spread evenly over the piece, one per texel of the finest texture, but no more
/// than samples_per_voxel for each voxel face's worth of area.
class MaterialFilter {
 public:
  /// Keeps a reference to the scene.
  explicit MaterialFilter(const Scene& scene);
  /// @param area of the piece, in voxel faces
  FilteredMaterial operator()(uint32_t triangle, const ClipPolygon& piece, double area) const;

  static constexpr int samples_per_voxel = 32;

 private:
  struct Entry {
    bool varies = false;            ///< over the surface
    FilteredMaterial constant;      ///< where it does not
    double texels[2] = {0.0, 0.0};  ///< per unit area of each texture coordinate set
  };
  int sample_count(const Entry& entry, uint32_t triangle, const ClipPolygon& piece, double area) const;

  const Scene& scene_;
  std::vector<Entry> entries_;  ///< one per material
};

}  // namespace voxref
