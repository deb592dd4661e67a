#include "compare/displayed.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "compare/flip.h"
#include "compare/ssim.h"
#include "image/planes.h"
#include "parallel.h"

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
  for (size_t i = 0; i < result.size(); ++i) result[i] = color_at(planes, i);
  return result;
}

double displayed_psnr(const Image& a, const Image& b, float exposure) {
  constexpr size_t grain = 1 << 16;
  const Planes planes_a = a.layer(""), planes_b = b.layer("");
  const float scale = std::exp2(exposure);
  const auto shown = [&](const Planes& planes, size_t i) {
    return glm::dvec3(encoded(glm::clamp(color_at(planes, i) * scale, 0.0f, 1.0f)));
  };
  std::vector<double> squares((a.pixel_count() + grain - 1) / grain, 0.0);
  parallel_for(a.pixel_count(), grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const glm::dvec3 difference = shown(planes_a, i) - shown(planes_b, i);
      squares[begin / grain] += glm::dot(difference, difference);
    }
  });
  const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
  return -10.0 * std::log10(sum / (3.0 * static_cast<double>(a.pixel_count())));
}

DisplayedDifference displayed_difference(const Image& a, const Image& b, float exposure) {
  const std::vector<glm::vec3> test = clipped(a, exposure), reference = clipped(b, exposure);
  DisplayedDifference result;
  result.psnr = displayed_psnr(a, b, exposure);
  result.ssim = ssim(a.width(), a.height(), luma(test), luma(reference));
  double sum = 0.0;
  for (const float value : flip_map(a.width(), a.height(), reference, test)) sum += double{value};
  result.flip = sum / static_cast<double>(a.pixel_count());
  return result;
}

}  // namespace voxref
