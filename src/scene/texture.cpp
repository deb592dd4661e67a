#include "scene/texture.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace voxref {

namespace {

float srgb_decode(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Linear value of each 8-bit code: a table, because decoding stands inside every look-up's inner loop.
std::array<float, 256> byte_table(bool srgb) {
  std::array<float, 256> table{};
  for (size_t i = 0; i < table.size(); ++i) {
    const float value = static_cast<float>(i) / 255.0f;
    table[i] = srgb ? srgb_decode(value) : value;
  }
  return table;
}
const std::array<float, 256> linear_bytes = byte_table(false);
const std::array<float, 256> srgb_bytes = byte_table(true);

/// Texel index after wrapping; `i` may be any finite index, `n` is the side.
int wrap(int i, int n, Wrap mode) {
  switch (mode) {
    case Wrap::clamp:
      return i < 0 ? 0 : i >= n ? n - 1 : i;
    case Wrap::mirror: {
      const int period = 2 * n;
      const int m = ((i % period) + period) % period;
      return m < n ? m : period - 1 - m;
    }
    default:
      return ((i % n) + n) % n;
  }
}

glm::vec4 decoded_texel(const TextureImage& image, bool srgb, int x, int y) {
  const size_t first = 4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x));
  if (!image.texels8.empty()) {
    const uint8_t* t = image.texels8.data() + first;
    const std::array<float, 256>& rgb = srgb ? srgb_bytes : linear_bytes;
    return {rgb[t[0]], rgb[t[1]], rgb[t[2]], linear_bytes[t[3]]};
  }
  const uint16_t* t = image.texels16.data() + first;
  const glm::vec4 value = glm::vec4(t[0], t[1], t[2], t[3]) / 65535.0f;
  return srgb ? glm::vec4(srgb_decode(value.r), srgb_decode(value.g), srgb_decode(value.b), value.a) : value;
}

/// Coordinates so large that a texel no longer has a float of its own would overflow the integer index below.
constexpr float largest_coordinate = 1e9f;

}  // namespace

glm::vec4 lookup(const TextureImage& image, const TextureBinding& binding, glm::vec2 uv) {
  uv = binding.transform * glm::vec3(uv, 1.0f);
  const auto texel = [&](int x, int y) {
    return decoded_texel(image, binding.srgb, wrap(x, image.width, binding.wrap_s),
                         wrap(y, image.height, binding.wrap_t));
  };
  glm::vec2 position = uv * glm::vec2(image.width, image.height);
  position = glm::clamp(position, glm::vec2(-largest_coordinate), glm::vec2(largest_coordinate));
  if (binding.nearest) return texel(static_cast<int>(std::floor(position.x)), static_cast<int>(std::floor(position.y)));

  position -= 0.5f;
  const glm::vec2 corner = glm::floor(position);
  const glm::vec2 f = position - corner;
  const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
  // Between equal texels exactly their value, which a (1 - t) + b t is not: bytes are rounded down after this.
  const auto mix = [](const glm::vec4& a, const glm::vec4& b, float t) { return a + t * (b - a); };
  return mix(mix(texel(x, y), texel(x + 1, y), f.x), mix(texel(x, y + 1), texel(x + 1, y + 1), f.x), f.y);
}

}  // namespace voxref
