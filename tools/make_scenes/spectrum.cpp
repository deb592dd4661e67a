#include "make_scenes/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vector_relational.hpp>

namespace voxref {
namespace {

constexpr double first_nm = 400.0, last_nm = 700.0, step_nm = 4.0;
using Measured = std::array<double, 76>;  // every 4 nm

constexpr Measured white_reflectance = {
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758, 0.739, 0.767, 0.777, 0.765,
    0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750, 0.746, 0.747, 0.735, 0.732, 0.739, 0.734, 0.725, 0.721,
    0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728, 0.716, 0.733, 0.726, 0.713, 0.740, 0.754, 0.764, 0.752, 0.736,
    0.734, 0.741, 0.740, 0.732, 0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.730,
    0.727, 0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739, 0.724, 0.730, 0.740, 0.737};
constexpr Measured green_reflectance = {
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096, 0.101, 0.103, 0.104,
    0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187, 0.229, 0.285, 0.343, 0.390, 0.435, 0.464, 0.472, 0.476,
    0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373, 0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.250, 0.230, 0.207,
    0.186, 0.171, 0.160, 0.148, 0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117,
    0.118, 0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.150, 0.152, 0.157, 0.159};
constexpr Measured red_reflectance = {
    0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061, 0.061, 0.060, 0.062,
    0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058, 0.058, 0.058, 0.056, 0.055, 0.056, 0.059, 0.057, 0.055,
    0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063, 0.063, 0.067, 0.068, 0.072, 0.080, 0.090, 0.099, 0.124, 0.154,
    0.192, 0.255, 0.287, 0.349, 0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606, 0.609, 0.651, 0.612, 0.610,
    0.650, 0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642};
constexpr std::array<double, 4> lamp_emission = {0.0, 8.0, 15.6, 18.4};  // every 100 nm

/// CIE standard illuminant D65 (ISO 11664-2), every 10 nm from 400 nm.
constexpr std::array<double, 31> d65 = {82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
                                        115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
                                        100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886,
                                        83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091};

/// Linear interpolation in a table that covers 400-700 nm in equal steps.
template <size_t size>
double spectrum_at(const std::array<double, size>& table, double nm) {
  const double place = (nm - first_nm) / (last_nm - first_nm) * (size - 1);
  const size_t i = std::min(static_cast<size_t>(place), size - 2);
  const double t = place - static_cast<double>(i);
  return (1.0 - t) * table[i] + t * table[i + 1];
}

/// A Gaussian with different widths on its two sides.
double lobe(double nm, double center, double width_below, double width_above) {
  const double t = (nm - center) / (nm < center ? width_below : width_above);
  return std::exp(-0.5 * t * t);
}

/// CIE 1931 2 degree observer, Wyman et al. 2013, listing 1.
glm::dvec3 color_matching(double nm) {
  return {
      1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
      0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
      1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

glm::dvec3 integrate_xyz(const std::function<double(double nm)>& spectrum) {
  glm::dvec3 sum(0.0);
  for (double nm = first_nm; nm <= last_nm; nm += step_nm) {
    const double weight = nm == first_nm || nm == last_nm ? 0.5 * step_nm : step_nm;
    sum += weight * spectrum(nm) * color_matching(nm);
  }
  return sum;
}

/// IEC 61966-2-1.
glm::dvec3 linear_srgb(const glm::dvec3& xyz) {
  return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z, -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
          0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

glm::vec3 four_decimals(const glm::dvec3& v) {
  const auto round = [](double x) { return static_cast<float>(std::round(x * 1e4) / 1e4); };
  return {round(v.x), round(v.y), round(v.z)};
}

glm::vec3 albedo(const Measured& reflectance) {
  const auto light = [](double nm) { return spectrum_at(d65, nm); };
  const auto reflected = [&](double nm) { return light(nm) * spectrum_at(reflectance, nm); };
  return four_decimals(linear_srgb(integrate_xyz(reflected)) / linear_srgb(integrate_xyz(light)));
}

}  // namespace

CornellColors cornell_colors() {
  const double sensitivity = integrate_xyz([](double) { return 1.0; }).y;
  const glm::dvec3 lamp = integrate_xyz([](double nm) { return spectrum_at(lamp_emission, nm); });
  return {albedo(white_reflectance), albedo(red_reflectance), albedo(green_reflectance), glm::vec3(0.78f),
          four_decimals(linear_srgb(lamp / sensitivity))};
}

}  // namespace voxref
