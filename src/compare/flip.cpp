#include "compare/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "compare/convolve.h"

// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020. Two pipelines: colours, blurred as the eye
// blurs them and compared in a space where distances are as large as they look (section 4.1), and features, edges and
// points of the luminance (section 4.2); a difference in features amplifies one in colour (section 4.3).
namespace voxref {

namespace {

constexpr float color_exponent = 0.7f;    // q_c
constexpr float knee_in = 0.4f;           // p_c: differences up to this fraction of the largest ...
constexpr float knee_out = 0.95f;         // p_t: ... take up this fraction of the output
constexpr float feature_exponent = 0.5f;  // q_f
constexpr float feature_width = 0.082f;   // w: degrees, the width of the lines that the eye detects best

/// Linear RGB (Rec. 709 primaries, D65) to CIE XYZ of a white of Y = 1: IEC 61966-2-1.
const glm::mat3 xyz_from_rgb = glm::transpose(glm::mat3(0.41239080f, 0.35758434f, 0.18048079f,  //
                                                        0.21263901f, 0.71516868f, 0.07219232f,  //
                                                        0.01933082f, 0.11919478f, 0.95053215f));
const glm::mat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
const glm::vec3 white = xyz_from_rgb * glm::vec3(1.0f);

/// A linear opponent space, so that blur in it is blur of light: Y achromatic, Cx red-green, Cz blue-yellow.
glm::vec3 ycxcz_from_rgb(const glm::vec3& rgb) {
  const glm::vec3 xyz = xyz_from_rgb * rgb / white;
  return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}

glm::vec3 rgb_from_ycxcz(const glm::vec3& c) {
  const float y = (c.x + 16.0f) / 116.0f;
  return rgb_from_xyz * (glm::vec3(y + c.y / 500.0f, y, y - c.z / 200.0f) * white);
}

/// CIE 1976 L*a*b*, then the Hunt effect: colours look more vivid the brighter they are.
glm::vec3 hunt_lab_from_rgb(const glm::vec3& rgb) {
  constexpr float delta = 6.0f / 29.0f;
  const glm::vec3 xyz = xyz_from_rgb * rgb / white;
  glm::vec3 f;
  for (int i = 0; i < 3; ++i)
    f[i] = xyz[i] > delta * delta * delta ? std::cbrt(xyz[i]) : xyz[i] / (3.0f * delta * delta) + 4.0f / 29.0f;
  const float lightness = 116.0f * f.y - 16.0f;
  return {lightness, 0.01f * lightness * 500.0f * (f.x - f.y), 0.01f * lightness * 200.0f * (f.y - f.z)};
}

/// HyAB, Abasi et al. 2020: city-block in lightness, Euclidean in chroma; right for large differences.
float hyab(const glm::vec3& a, const glm::vec3& b) {
  return std::abs(a.x - b.x) + glm::length(glm::vec2(a.y, a.z) - glm::vec2(b.y, b.z));
}

/// A Gaussian a sqrt(pi/b) exp(-pi^2 r^2 / b), r in degrees: the transform of a exp(-b f^2), f in cycles per degree.
struct Gaussian {
  float a, b;
};
/// The paper's fit of the contrast sensitivity functions, table 1, by channel.
constexpr Gaussian achromatic{1.0f, 0.0047f}, red_green{1.0f, 0.0053f};
constexpr std::array<Gaussian, 2> blue_yellow = {{{34.1f, 0.04f}, {13.5f, 0.025f}}};

using Plane = std::vector<float>;

struct Size {
  int width, height;
  size_t count() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

/// Taps of one axis, of sum 1; three standard deviations of the widest Gaussian on each side, as the paper has it.
Plane gaussian_taps(float b, float pixels_per_degree) {
  constexpr float widest_b = blue_yellow[0].b;
  constexpr float pi = std::numbers::pi_v<float>;
  const int radius = static_cast<int>(std::ceil(3.0f * std::sqrt(widest_b / (2.0f * pi * pi)) * pixels_per_degree));
  Plane taps;
  float sum = 0.0f;
  for (int i = -radius; i <= radius; ++i) {
    const float degrees = static_cast<float>(i) / pixels_per_degree;
    taps.push_back(std::exp(-pi * pi * degrees * degrees / b));
    sum += taps.back();
  }
  for (float& tap : taps) tap /= sum;
  return taps;
}

Plane blur(Size size, const Plane& plane, float b, float pixels_per_degree) {
  const Plane taps = gaussian_taps(b, pixels_per_degree);
  return convolve<float>(size.width, size.height, plane, taps, taps);
}

/// Share of the first of the blue-yellow Gaussians in their normalized sum: each is blurred on its own because their
/// sum is not separable. The volume of one in the plane is a sqrt(pi/b) (b/pi), so a sqrt(b) up to a common factor.
float first_blue_yellow_share() {
  const float first = blue_yellow[0].a * std::sqrt(blue_yellow[0].b);
  const float second = blue_yellow[1].a * std::sqrt(blue_yellow[1].b);
  return first / (first + second);
}

/// What is left of the picture's colours after the eye's blur, in the space of hunt_lab_from_rgb.
std::vector<glm::vec3> perceived_colors(Size size, std::span<const glm::vec3> rgb, float pixels_per_degree) {
  std::array<Plane, 3> planes;
  for (Plane& plane : planes) plane.resize(size.count());
  for (size_t i = 0; i < size.count(); ++i) {
    const glm::vec3 opponent = ycxcz_from_rgb(rgb[i]);
    for (int c = 0; c < 3; ++c) planes[static_cast<size_t>(c)][i] = opponent[c];
  }
  const Plane y = blur(size, planes[0], achromatic.b, pixels_per_degree);
  const Plane cx = blur(size, planes[1], red_green.b, pixels_per_degree);
  const Plane cz_wide = blur(size, planes[2], blue_yellow[0].b, pixels_per_degree);
  const Plane cz_narrow = blur(size, planes[2], blue_yellow[1].b, pixels_per_degree);
  const float share = first_blue_yellow_share();
  std::vector<glm::vec3> colors(size.count());
  for (size_t i = 0; i < size.count(); ++i) {
    const glm::vec3 opponent(y[i], cx[i], share * cz_wide[i] + (1.0f - share) * cz_narrow[i]);
    colors[i] = hunt_lab_from_rgb(glm::clamp(rgb_from_ycxcz(opponent), 0.0f, 1.0f));
  }
  return colors;
}

/// Compresses large colour differences, which all look "very different", into the last 5 % of [0,1].
float redistribute(float distance) {
  static const float largest =
      std::pow(hyab(hunt_lab_from_rgb({0.0f, 1.0f, 0.0f}), hunt_lab_from_rgb({0.0f, 0.0f, 1.0f})), color_exponent);
  const float raised = std::pow(distance, color_exponent), knee = knee_in * largest;
  return raised < knee ? knee_out * raised / knee : knee_out + (1.0f - knee_out) * (raised - knee) / (largest - knee);
}

/// Scales the positive taps to a sum of 1 and the negative ones to -1, so that a full step or line gives 1.
void normalize_signs(Plane& taps) {
  float positive = 0.0f, negative = 0.0f;
  for (const float tap : taps) (tap > 0.0f ? positive : negative) += std::abs(tap);
  for (float& tap : taps) tap /= tap > 0.0f ? positive : negative;
}

struct Features {
  Plane edges, points;  ///< lengths of the filters' responses along x and y
};

/// Edges (first derivative of a Gaussian) and points (second) of the luminance in [0,1].
Features features(Size size, std::span<const glm::vec3> rgb, float pixels_per_degree) {
  const float deviation = 0.5f * feature_width * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0f * deviation));
  Plane smooth, first, second;
  float sum = 0.0f;
  for (int i = -radius; i <= radius; ++i) {
    const auto x = static_cast<float>(i);
    const float gaussian = std::exp(-0.5f * x * x / (deviation * deviation));
    sum += gaussian;
    smooth.push_back(gaussian);
    first.push_back(-x * gaussian);
    second.push_back((x * x / (deviation * deviation) - 1.0f) * gaussian);
  }
  for (float& tap : smooth) tap /= sum;
  normalize_signs(first);
  normalize_signs(second);

  Plane luminance(size.count());
  for (size_t i = 0; i < size.count(); ++i) luminance[i] = (xyz_from_rgb * rgb[i]).y;
  const auto response = [&](const Plane& derivative) {
    Plane length = convolve<float>(size.width, size.height, luminance, derivative, smooth);
    const Plane along_y = convolve<float>(size.width, size.height, luminance, smooth, derivative);
    for (size_t i = 0; i < length.size(); ++i) length[i] = std::hypot(length[i], along_y[i]);
    return length;
  };
  return {response(first), response(second)};
}

}  // namespace

std::vector<float> flip_map(int width, int height, std::span<const glm::vec3> reference,
                            std::span<const glm::vec3> test, float pixels_per_degree) {
  const Size size{width, height};
  assert(reference.size() == size.count() && test.size() == size.count());
  const std::vector<glm::vec3> colors_r = perceived_colors(size, reference, pixels_per_degree);
  const std::vector<glm::vec3> colors_t = perceived_colors(size, test, pixels_per_degree);
  const Features features_r = features(size, reference, pixels_per_degree);
  const Features features_t = features(size, test, pixels_per_degree);
  std::vector<float> map(size.count());
  for (size_t i = 0; i < map.size(); ++i) {
    const float color = redistribute(hyab(colors_r[i], colors_t[i]));
    const float feature = std::max(std::abs(features_r.edges[i] - features_t.edges[i]),
                                   std::abs(features_r.points[i] - features_t.points[i]));
    const float amplifier = std::pow(feature / std::numbers::sqrt2_v<float>, feature_exponent);
    map[i] = std::pow(color, 1.0f - amplifier);
  }
  return map;
}

}  // namespace voxref
