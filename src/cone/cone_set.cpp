#include "cone/cone_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "error.h"
#include "scene/reflectance.h"

namespace voxref {
namespace {

constexpr double pi = std::numbers::pi;

/// How many of `cells` equal cells of a cap, each of solid angle `omega`, lie inside its outermost ring. The ring is as
/// high as a square cell (Beckers and Beckers 2012, eq. 2), and solid angles inside it follow from its inner edge.
int cells_inside_ring(int cells, double omega) {
  if (cells <= 3) return 0;  // sectors: a ring around a cap needs three cells to have a direction of its own
  const double outer = std::acos(1.0 - cells * omega / (2.0 * pi));
  const double inner = std::max(0.0, outer - std::sqrt(omega));
  const int inside = static_cast<int>(std::lround(2.0 * pi * (1.0 - std::cos(inner)) / omega));
  // A centre of two or three cells would be sectors without a cell at the pole, where most of the light counts.
  return inside < 4 ? 1 : std::min(inside, cells - 3);
}

/// Texels are narrower than the cone that samples them, in proportion to its tangent. A surface seems up to a texel
/// nearer than it is: an error of the first order in their width. That a cone is sampled along its axis alone is one of
/// the second order in the cone's. So as cones narrow, texels must narrow with their square. In proportion, up to six
/// cones sample texels as wide as they are; there finer ones cost more by what lies beside the axis than they gain
/// (measured on the Cornell box: relative error 0.44, 0.50 at half the width, 0.62 at a quarter), from 64 cones on they
/// gain (0.32, 0.30, 0.23).
float texel_over_diameter(float tan_half_angle) {
  constexpr float whole = 0.66332f;  // tan of six cones' half-angle, cos = 5/6
  return std::min(tan_half_angle / whole, 1.0f);
}

/// Appends the `count` cells between two polar angles. With sectors of width w = 2 pi / count, around azimuth phi:
///   weight        = integral cos sin dtheta dphi            = w (sin^2 t1 - sin^2 t0) / 2
///   mean, across  = integral sin cos(phi') cos sin          = 2 sin(w/2) (sin^3 t1 - sin^3 t0) / 3
///   mean, along z = integral cos^2 sin dtheta dphi          = w (cos^3 t0 - cos^3 t1) / 3
void add_ring(std::vector<Cone>& cones, int count, double cos0, double cos1, float tan_half_angle) {
  const double sin0 = std::sqrt(1.0 - cos0 * cos0), sin1 = std::sqrt(1.0 - cos1 * cos1);
  const double width = 2.0 * pi / count;
  const double weight = width * (sin1 * sin1 - sin0 * sin0) / 2.0;
  const double across = count == 1 ? 0.0 : 2.0 * std::sin(width / 2.0) * (std::pow(sin1, 3) - std::pow(sin0, 3)) / 3.0;
  const double along = width * (std::pow(cos0, 3) - std::pow(cos1, 3)) / 3.0;
  const double length = std::hypot(across, along);
  for (int i = 0; i < count; ++i) {
    const double phi = width * i;
    cones.push_back({glm::vec3(across * std::cos(phi) / length, across * std::sin(phi) / length, along / length),
                     static_cast<float>(weight), tan_half_angle, texel_over_diameter(tan_half_angle)});
  }
}

}  // namespace

std::vector<Cone> partition_hemisphere(int count) {
  if (count < 1 || count > most_cones)
    throw Error("cone count", std::to_string(count) + " is outside the range 1 to " + std::to_string(most_cones));
  const double omega = 2.0 * pi / count;
  // Half-angle a with 2 pi (1 - cos a) = omega; one cone for everything would be 90 degrees, of which no cube of texels
  // is a picture, so that 60 degrees are the widest.
  const double cos_half_angle = std::max(1.0 - 1.0 / count, 0.5);
  const float tan_half_angle = static_cast<float>(std::sqrt(1.0 - cos_half_angle * cos_half_angle) / cos_half_angle);

  std::vector<int> bounds = {count};  // cells inside each ring's outer edge, from the horizon to the pole
  while (bounds.back() > 0) bounds.push_back(bounds.back() == 1 ? 0 : cells_inside_ring(bounds.back(), omega));
  std::reverse(bounds.begin(), bounds.end());

  std::vector<Cone> cones;
  cones.reserve(static_cast<size_t>(count));
  for (size_t ring = 1; ring < bounds.size(); ++ring)
    add_ring(cones, bounds[ring] - bounds[ring - 1], 1.0 - double(bounds[ring - 1]) / count,
             1.0 - double(bounds[ring]) / count, tan_half_angle);
  return cones;
}

Coverage coverage(const std::vector<Cone>& cones) {
  constexpr int rows = 128, columns = 256;  // equal solid angles; error below 0.01 for up to a thousand cones
  std::vector<float> cos_half_angles;
  for (const Cone& cone : cones)
    cos_half_angles.push_back(1.0f / std::sqrt(1.0f + cone.tan_half_angle * cone.tan_half_angle));

  int covered = 0, overlapping = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double z = (row + 0.5) / rows, r = std::sqrt(1.0 - z * z), phi = 2.0 * pi * (column + 0.5) / columns;
      const glm::vec3 direction(r * std::cos(phi), r * std::sin(phi), z);
      int inside = 0;
      for (size_t i = 0; i < cones.size() && inside < 2; ++i)
        inside += glm::dot(direction, cones[i].direction) >= cos_half_angles[i];
      covered += inside > 0;
      overlapping += inside > 1;
    }
  return {double(covered) / (rows * columns), double(overlapping) / (rows * columns)};
}

glm::mat3 frame_around(const glm::vec3& n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  return {glm::vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x), glm::vec3(b, sign + n.y * n.y * a, -n.y), n};
}

namespace {

/// A cone along (a, b, 1) / |(a, b, 1)|.
Cone tilted(float a, float b, float weight, float tan_half_angle) {
  return {glm::normalize(glm::vec3(a, b, 1.0f)), weight, tan_half_angle};
}

}  // namespace

// Numbers as the shaders write them, the fourth direction's slip of 0.0003 from symmetry included.
std::vector<Cone> villegas6_cones() {
  constexpr float tan30 = 0.57735f, top = float(pi / 4.0), side = float(3.0 * pi / 20.0);
  return {tilted(0.0f, 0.0f, top, tan30),
          tilted(0.0f, 0.866025f, side, tan30),
          tilted(0.823639f, 0.267617f, side, tan30),
          tilted(0.509037f, -0.7006629f, side, tan30),
          tilted(-0.50937f, -0.7006629f, side, tan30),
          tilted(-0.823639f, 0.267617f, side, tan30)};
}

std::vector<Cone> villegas4_cones() {
  constexpr float half = 0.5f, top = float(pi / 3.0), side = float(2.0 * pi / 9.0);
  return {tilted(0.0f, 0.0f, top, half), tilted(0.0f, 0.866025f, side, half),
          tilted(0.754996f, -0.4330128f, side, half), tilted(-0.754996f, -0.4330128f, side, half)};
}

glm::mat3 guided_frame(const glm::vec3& n) {
  const glm::vec3 guide = std::abs(n.y) == 1.0f ? glm::vec3(0.0f, 0.0f, 1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
  const glm::vec3 right = glm::normalize(guide - glm::dot(n, guide) * n);
  return {right, glm::cross(right, n), n};
}

ConeSet pixel_cones(int count) {
  if (count == published_cones) return {villegas6_cones(), guided_frame};
  return {partition_hemisphere(count), frame_around};
}

ConeSet voxel_cones(int count) {
  if (count == published_cones) return {villegas4_cones(), guided_frame};
  return {partition_hemisphere(count), frame_around};
}

float published_specular_tan_half_angle(float glossiness) {
  constexpr float least = 0.0174533f, most = float(pi);  // angles in the shader, though a tangent is meant
  return std::clamp(std::tan(1.57079f * (1.0f - glossiness)), least, most);
}

namespace {

/// Tangent of the half-angle over alpha, for one lobe. With viewer and normal along z, a half-vector at angle h
/// reflects to l at 2h, so that n.l = cos 2h, and with D cos(h) dw_h = du for tan^2 h = alpha^2 u / (1 - u), dw_l = 4
/// cos(h) dw_h:
///
///   mean direction length m = integral (n.l)^2 V du / integral (n.l) V du,   V = Smith visibility
///
/// over h < 45 degrees. 1 - u = e^-t spreads the samples over the long tail. A uniform cone of half-angle b has m =
/// (1 + cos b) / 2, thus 1 - cos b = 2 (1 - m); 1 - m is summed as such, since m itself rounds to 1 for narrow lobes.
double fitted_tan_over_alpha(double alpha) {
  constexpr int steps = 512;
  const double end = std::log1p(1.0 / (alpha * alpha));
  double lobe = 0.0, shortfall = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = end * (i + 0.5) / steps;
    const double tan2 = alpha * alpha * std::expm1(t);
    const double n_l = (1.0 - tan2) / (1.0 + tan2);
    const double weight = std::exp(-t) * n_l * ggx_visibility(static_cast<float>(n_l), 1.0f, static_cast<float>(alpha));
    lobe += weight;
    shortfall += weight * 2.0 * tan2 / (1.0 + tan2);  // 1 - n.l
  }
  const double versine = 2.0 * shortfall / lobe;  // 1 - cos b
  return std::sqrt(versine * (2.0 - versine)) / (1.0 - versine) / alpha;
}

}  // namespace

float specular_tan_half_angle(float alpha) {
  // Over perceptual roughness, where the ratio is smooth: linear interpolation of 64 entries errs by less than 0.5 %.
  constexpr int entries = 64;
  constexpr double least = 0.03162278;  // sqrt(Reflectance::min_alpha)
  static const std::array<float, entries> table = [] {
    std::array<float, entries> t{};
    for (int i = 0; i < entries; ++i) {
      const double roughness = least + (1.0 - least) * i / (entries - 1);
      t[size_t(i)] = static_cast<float>(fitted_tan_over_alpha(roughness * roughness));
    }
    return t;
  }();
  alpha = std::clamp(alpha, Reflectance::min_alpha, 1.0f);
  const float x = (std::sqrt(alpha) - float(least)) / float(1.0 - least) * (entries - 1);
  const int i = std::clamp(static_cast<int>(x), 0, entries - 2);
  const float f = std::clamp(x - static_cast<float>(i), 0.0f, 1.0f);
  return alpha * ((1.0f - f) * table[size_t(i)] + f * table[size_t(i) + 1]);
}

}  // namespace voxref
