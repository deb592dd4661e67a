#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <span>

#include "image/image.h"

namespace voxref {

/// The three planes of a layer.
using Planes = std::array<std::span<const float>, 3>;

inline glm::vec3 color_at(const Planes& planes, size_t pixel) {
  return {planes[0][pixel], planes[1][pixel], planes[2][pixel]};
}
inline float luminance_at(const Planes& planes, size_t pixel) { return luminance(color_at(planes, pixel)); }

}  // namespace voxref
