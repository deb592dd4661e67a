#pragma once
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "voxel/array_file.h"

namespace voxref {

/// An image of the published shaders' output: RGBA (depth: one channel), row 0 at the top; bytes as values in [0,1].
struct GpuImage {
  size_t width = 0, height = 0, channels = 0;
  std::vector<float> values;  ///< [row][column][channel]

  glm::vec3 rgb(size_t pixel) const {
    const float* v = &values[pixel * channels];
    return {v[0], v[1], v[2]};
  }
  float operator()(size_t pixel, size_t channel) const { return values[pixel * channels + channel]; }
};

/// @param folder of one configuration, for instance shared/gpu/cornell_64
inline GpuImage gpu_image(const std::filesystem::path& folder, const std::string& name) {
  ArrayFile file(folder / "images" / (name + ".npy"));
  GpuImage image{file.shape()[2], file.shape()[1], file.shape()[3], std::vector<float>(file.slice_size())};
  file.read_slice(0, image.values);
  return image;
}

/// Differences between two pictures, tone-mapped as the shaders do: x / (1 + x), then the power 1 / 2.2.
struct Differences {
  double median = 0, percentile_99 = 0, percentile_99_9 = 0, largest = 0;
  size_t worst = 0;               ///< the pixel with the largest
  std::vector<double> per_pixel;  ///< greatest of the three channels
};
inline float tone_mapped(float x) { return std::pow(x / (1.0f + x), 1.0f / 2.2f); }

inline Differences differences(const std::vector<glm::vec3>& ours, const GpuImage& theirs) {
  Differences result;
  for (size_t i = 0; i < ours.size(); ++i) {
    double greatest = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double d = std::abs(double(tone_mapped(ours[i][c])) - tone_mapped(theirs(i, size_t(c))));
      greatest = d <= greatest ? greatest : d;  // a NaN stays
    }
    if (!(greatest <= result.largest)) result.largest = greatest, result.worst = i;
    result.per_pixel.push_back(greatest);
  }
  std::vector<double> sorted = result.per_pixel;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) { return sorted[size_t(share * double(sorted.size() - 1))]; };
  result.median = at(0.5), result.percentile_99 = at(0.99), result.percentile_99_9 = at(0.999);
  return result;
}

}  // namespace voxref
