#include "scene/texture.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "image/transfer.h"

namespace voxref {

namespace {

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
  if (i >= 0 && i < n) return i;  // most are, and a division takes as long as half a look-up
  switch (mode) {
    case Wrap::clamp:
      return i < 0 ? 0 : n - 1;
    case Wrap::mirror: {
      const int period = 2 * n;
      const int m = ((i % period) + period) % period;
      return m < n ? m : period - 1 - m;
    }
    default: {
      const int m = i % n;
      return m < 0 ? m + n : m;
    }
  }
}

size_t texel_offset(const TextureImage& image, int x, int y) {
  return 4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x));
}

glm::vec4 decoded_texel(const TextureImage& image, bool srgb, int x, int y) {
  const size_t first = texel_offset(image, x, y);
  if (!image.texels8.empty()) {
    const uint8_t* t = image.texels8.data() + first;
    const std::array<float, 256>& rgb = srgb ? srgb_bytes : linear_bytes;
    return {rgb[t[0]], rgb[t[1]], rgb[t[2]], linear_bytes[t[3]]};
  }
  const uint16_t* t = image.texels16.data() + first;
  const glm::vec4 value = glm::vec4(t[0], t[1], t[2], t[3]) / 65535.0f;
  return srgb ? glm::vec4(srgb_decode(value.r), srgb_decode(value.g), srgb_decode(value.b), value.a) : value;
}

/// Largest integer not above x, for |x| < 2^31. std::floor is a library call where SSE4.1 is not assumed.
int floor_to_int(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x);
}

/// Coordinates so large that a texel no longer has a float of its own would overflow the integer index below.
constexpr float largest_coordinate = 1e9f;

/// The texels around a place: two columns and two rows, wrapped, and how far it lies towards the second of each.
struct Footprint {
  int x0, x1, y0, y1;
  glm::vec2 f;
};

Footprint footprint(const TextureImage& image, const TextureBinding& binding, const glm::vec2& uv) {
  glm::vec2 position = binding.transform * glm::vec3(uv, 1.0f) * glm::vec2(image.width, image.height);
  position = glm::clamp(position, glm::vec2(-largest_coordinate), glm::vec2(largest_coordinate));
  if (!binding.nearest) position -= 0.5f;
  const int x = floor_to_int(position.x), y = floor_to_int(position.y);
  return {wrap(x, image.width, binding.wrap_s), wrap(x + 1, image.width, binding.wrap_s),
          wrap(y, image.height, binding.wrap_t), wrap(y + 1, image.height, binding.wrap_t), position - glm::vec2(x, y)};
}

}  // namespace

glm::vec4 lookup(const TextureImage& image, const TextureBinding& binding, const glm::vec2& uv) {
  const Footprint p = footprint(image, binding, uv);
  const auto texel = [&](int x, int y) { return decoded_texel(image, binding.srgb, x, y); };
  if (binding.nearest) return texel(p.x0, p.y0);
  // Between equal texels exactly their value, which a (1 - t) + b t is not: bytes are rounded down after this.
  const auto mix = [](const glm::vec4& a, const glm::vec4& b, float t) { return a + t * (b - a); };
  return mix(mix(texel(p.x0, p.y0), texel(p.x1, p.y0), p.f.x), mix(texel(p.x0, p.y1), texel(p.x1, p.y1), p.f.x), p.f.y);
}

void prefetch(const TextureImage& image, const TextureBinding& binding, const glm::vec2& uv) {
  const Footprint p = footprint(image, binding, uv);
  for (const int y : {p.y0, p.y1}) {
    const size_t offset = texel_offset(image, p.x0, y);
    if (!image.texels8.empty())
      __builtin_prefetch(image.texels8.data() + offset);
    else
      __builtin_prefetch(image.texels16.data() + offset);
  }
}

}  // namespace voxref
