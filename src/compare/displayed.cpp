#include "compare/displayed.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compare/flip.h"
#include "compare/ssim.h"

namespace voxref {

namespace {

/// What the display gets, in linear light.
std::vector<glm::vec3> clipped(const Image& image, float exposure) {
  const float scale = std::exp2(exposure);
  std::vector<glm::vec3> result = colors(image);
  for (glm::vec3& color : result) color = glm::clamp(color * scale, 0.0f, 1.0f);
  return result;
}

glm::vec3 encoded(const glm::vec3& linear) {
  return {srgb_encode(linear.r), srgb_encode(linear.g), srgb_encode(linear.b)};
}

double psnr_of(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  double squares = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 difference = glm::dvec3(encoded(a[i])) - glm::dvec3(encoded(b[i]));
    squares += glm::dot(difference, difference);
  }
  return -10.0 * std::log10(squares / (3.0 * static_cast<double>(a.size())));
}

/// BT.709 luma: the weights of luminance on encoded values.
std::vector<float> luma(const std::vector<glm::vec3>& linear) {
  std::vector<float> result(linear.size());
  for (size_t i = 0; i < result.size(); ++i) result[i] = luminance(encoded(linear[i]));
  return result;
}

}  // namespace

std::vector<glm::vec3> colors(const Image& image) {
  const auto planes = image.layer("");
  std::vector<glm::vec3> result(image.pixel_count());
  for (size_t i = 0; i < result.size(); ++i) result[i] = {planes[0][i], planes[1][i], planes[2][i]};
  return result;
}

double displayed_psnr(const Image& a, const Image& b, float exposure) {
  return psnr_of(clipped(a, exposure), clipped(b, exposure));
}

DisplayedDifference displayed_difference(const Image& a, const Image& b, float exposure) {
  const std::vector<glm::vec3> test = clipped(a, exposure), reference = clipped(b, exposure);
  DisplayedDifference result;
  result.psnr = psnr_of(test, reference);
  result.ssim = ssim(a.width(), a.height(), luma(test), luma(reference));
  double sum = 0.0;
  for (const float value : flip_map(a.width(), a.height(), reference, test)) sum += double{value};
  result.flip = sum / static_cast<double>(a.pixel_count());
  return result;
}

}  // namespace voxref
