#pragma once
#include <cmath>
#include <glm/vec3.hpp>
#include <random>
#include <string>

#include "image/image.h"

// Images as the two renderers give them, made from a function of the pixel.
namespace voxref::testing {

template <class Function>  // (x, y) -> glm::vec3
void fill_layer(Image& image, const std::string& layer, Function&& radiance) {
  image.add_layer(layer);
  const auto planes = image.layer(layer);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const glm::vec3 rgb = radiance(x, y);
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(image.width()) + static_cast<size_t>(x);
      for (int c = 0; c < 3; ++c) planes[static_cast<size_t>(c)][i] = rgb[c];
    }
}

/// A smooth picture with an edge, between 0.1 and 0.8.
inline glm::vec3 wavy(int x, int y) {
  const float wave = 0.3f + 0.2f * std::sin(0.13f * static_cast<float>(x)) * std::cos(0.07f * static_cast<float>(y));
  return x < 30 ? glm::vec3(0.8f, 0.7f, 0.6f) : glm::vec3(wave, 0.7f * wave, 1.1f * wave);
}

template <class Function>
Image cone_image(int width, int height, Function&& radiance) {
  Image image(width, height);
  fill_layer(image, "", radiance);
  // The parts of the sum: half of it direct, three eighths diffuse and one eighth specular.
  const auto part = [&](float share) { return [&, share](int x, int y) { return share * radiance(x, y); }; };
  fill_layer(image, "direct", part(0.5f));
  fill_layer(image, "diffuse", part(0.375f));
  fill_layer(image, "specular", part(0.125f));
  return image;
}

/// @param standard_error of the luminance, in stderr.Y and stderr.indirect.Y; the pixels themselves get no noise
template <class Function>
Image path_image(int width, int height, Function&& radiance, float standard_error = 0.0f) {
  Image image(width, height);
  fill_layer(image, "", radiance);
  const auto half = [&](int x, int y) { return 0.5f * radiance(x, y); };
  fill_layer(image, "direct", half);
  fill_layer(image, "indirect", half);
  for (const char* channel : {"stderr.Y", "stderr.indirect.Y"})
    for (float& value : image.add(channel)) value = standard_error;
  return image;
}

/// Adds the same normal deviate to R, G and B of a pixel, so that its luminance has that standard deviation.
inline void add_noise(Image& image, const std::string& layer, float standard_deviation, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(0.0f, standard_deviation);
  const auto planes = image.layer(layer);
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const float deviate = normal(generator);
    for (const auto& plane : planes) plane[i] += deviate;
  }
}

}  // namespace voxref::testing
