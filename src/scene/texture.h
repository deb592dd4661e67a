#pragma once
#include <cstdint>
#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace voxref {

/// Texels as the file stores them, RGBA, row 0 at the top (texture coordinate v = 0). Exactly one of the two is filled.
struct TextureImage {
  std::string name;
  int width = 0, height = 0;
  std::vector<uint8_t> texels8;    ///< 4 * width * height, for files of up to 8 bits per channel
  std::vector<uint16_t> texels16;  ///< the same for 16-bit files
};

enum class Wrap : uint8_t { repeat, mirror, clamp };

/// How a material uses an image: which texture coordinates, how they are moved and wrapped, what the texels mean.
struct TextureBinding {
  int image = -1;  ///< index into Scene::images; -1: none
  int uv_set = 0;  ///< 0 or 1
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  bool nearest = false;                       ///< the sampler's magnification filter is NEAREST
  bool srgb = false;                          ///< RGB is sRGB-encoded (alpha never is)
  glm::mat3x2 transform = glm::mat3x2(1.0f);  ///< KHR_texture_transform: uv' = transform * (u, v, 1)

  explicit operator bool() const { return image >= 0; }
};

/// Looks `binding` up at texture coordinate `uv` (before its transform): texels are decoded to linear values first,
/// then interpolated bilinearly at full resolution (texel centres at half-integers) unless the sampler says NEAREST.
/// @param uv finite; components in [0,1] per repetition
glm::vec4 lookup(const TextureImage& image, const TextureBinding& binding, const glm::vec2& uv);
/// Asks the processor for the texels that lookup() will read, without waiting for them.
void prefetch(const TextureImage& image, const TextureBinding& binding, const glm::vec2& uv);

}  // namespace voxref
