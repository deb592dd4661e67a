#include "image/image.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "error.h"

namespace voxref {

namespace {
constexpr int max_side = 65536;  // beyond it a size is a typing error, and indices stay well inside 64 bits
constexpr std::array<std::string_view, 3> rgb_names = {"R", "G", "B"};
}  // namespace

std::string channel_name(std::string_view layer, std::string_view channel) {
  return layer.empty() ? std::string(channel) : std::string(layer) + "." + std::string(channel);
}

float srgb_encode(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

Image::Image(int width, int height) : width_(width), height_(height) {
  if (width < 1 || height < 1 || width > max_side || height > max_side)
    throw Error("image size", std::to_string(width) + "x" + std::to_string(height) + " is outside 1x1 to 65536x65536");
}

bool Image::has(std::string_view channel) const {
  return std::find(names_.begin(), names_.end(), channel) != names_.end();
}

std::span<float> Image::add(const std::string& channel) {
  if (!has(channel)) {
    names_.push_back(channel);
    planes_.emplace_back(pixel_count(), 0.0f);
  }
  return this->channel(channel);
}

std::span<const float> Image::channel(std::string_view channel) const {
  const auto found = std::find(names_.begin(), names_.end(), channel);
  if (found == names_.end()) throw Error("image", "has no channel '" + std::string(channel) + "'");
  return planes_[static_cast<size_t>(found - names_.begin())];
}

std::span<float> Image::channel(std::string_view channel) {
  const std::span<const float> plane = std::as_const(*this).channel(channel);
  return {const_cast<float*>(plane.data()), plane.size()};
}

bool Image::has_layer(std::string_view layer) const {
  return std::all_of(rgb_names.begin(), rgb_names.end(),
                     [&](std::string_view name) { return has(channel_name(layer, name)); });
}

void Image::add_layer(const std::string& layer) {
  for (const std::string_view name : rgb_names) add(channel_name(layer, name));
}

std::array<std::span<const float>, 3> Image::layer(std::string_view layer) const {
  return {channel(channel_name(layer, "R")), channel(channel_name(layer, "G")), channel(channel_name(layer, "B"))};
}

std::array<std::span<float>, 3> Image::layer(std::string_view layer) {
  return {channel(channel_name(layer, "R")), channel(channel_name(layer, "G")), channel(channel_name(layer, "B"))};
}

}  // namespace voxref
