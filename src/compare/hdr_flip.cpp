#include "compare/hdr_flip.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "compare/flip.h"
#include "image/image.h"

namespace voxref {

namespace {

/// (a x^2 + b x) / (c x^2 + d x + e) of 0.6 x: Narkowicz 2015, "ACES Filmic Tone Mapping Curve", with Hable's scale.
constexpr float scale = 0.6f;
constexpr float a = 2.51f * scale * scale, b = 0.03f * scale, c = 2.43f * scale * scale, d = 0.59f * scale, e = 0.14f;

glm::vec3 tone_mapped(const glm::vec3& radiance) {
  constexpr float long_white = 1e9f;  // and far below where squares overflow, which would make NaN of a light
  const glm::vec3 x = glm::clamp(radiance, 0.0f, long_white);
  return glm::clamp((x * (a * x + b)) / (x * (c * x + d) + e), 0.0f, 1.0f);
}

/// What the tone mapper takes to 0.85, which the paper counts as nearly white: the root of
/// (a - 0.85 c) x^2 + (b - 0.85 d) x - 0.85 e.
float nearly_white() {
  constexpr float shown = 0.85f;
  const float square = a - shown * c, linear = b - shown * d, constant = -shown * e;
  const float half = -0.5f * linear / square;
  return half + std::sqrt(half * half - constant / square);
}

}  // namespace

FlipExposures flip_exposures(std::span<const glm::vec3> reference) {
  std::vector<float> luminances;
  luminances.reserve(reference.size());
  for (const glm::vec3& color : reference) luminances.push_back(luminance(color));
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const float least = std::numeric_limits<float>::epsilon();  // of a median that is 0 no exposure makes anything
  const float median = std::max(*middle, least);
  const float largest = std::max(*std::max_element(luminances.begin(), luminances.end()), least);
  FlipExposures exposures;
  exposures.start = std::log2(nearly_white() / largest);
  exposures.stop = std::log2(nearly_white() / median);
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

std::vector<float> hdr_flip_map(int width, int height, std::span<const glm::vec3> reference,
                                std::span<const glm::vec3> test, const FlipExposures& exposures,
                                const Progress& progress) {
  std::vector<float> largest(reference.size(), 0.0f);
  std::vector<glm::vec3> shown_reference(reference.size()), shown_test(test.size());
  for (int i = 0; i < exposures.count; ++i) {
    progress.check();
    progress("HDR-FLIP", static_cast<double>(i) / exposures.count);
    const float share = exposures.count > 1 ? static_cast<float>(i) / static_cast<float>(exposures.count - 1) : 0.0f;
    const float gain = std::exp2(exposures.start + share * (exposures.stop - exposures.start));
    std::transform(reference.begin(), reference.end(), shown_reference.begin(),
                   [&](const glm::vec3& color) { return tone_mapped(gain * color); });
    std::transform(test.begin(), test.end(), shown_test.begin(),
                   [&](const glm::vec3& color) { return tone_mapped(gain * color); });
    const std::vector<float> map = flip_map(width, height, shown_reference, shown_test);
    std::transform(map.begin(), map.end(), largest.begin(), largest.begin(),
                   [](float x, float y) { return std::max(x, y); });
  }
  return largest;
}

}  // namespace voxref
