#pragma once
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "image/image.h"

namespace voxref {

/// An image or a volume in memory, as what both have in common: [z][y][x][channel], an image with one z.
struct Field {
  glm::ivec3 size{0};
  int channels = 0;  ///< 1 to 4
  std::vector<float> values;

  size_t texel_count() const { return size_t(size.x) * size_t(size.y) * size_t(size.z); }
  size_t index(const glm::ivec3& v) const {
    return size_t(v.x) + size_t(size.x) * (size_t(v.y) + size_t(size.y) * size_t(v.z));
  }
  glm::ivec3 place(size_t texel) const {
    const auto x = size_t(size.x), y = size_t(size.y);
    return {int(texel % x), int(texel / x % y), int(texel / x / y)};
  }
  /// Missing colours are 0, a missing alpha is 1.
  glm::vec4 texel(const glm::ivec3& v) const {
    glm::vec4 t(0.0f, 0.0f, 0.0f, 1.0f);
    const float* from = values.data() + index(v) * size_t(channels);
    for (int c = 0; c < channels; ++c) t[c] = from[c];
    return t;
  }
};

/// R,G,B of an image.
Field field_of(const Image& image);

}  // namespace voxref
