#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace voxref {

/// Pixels with named float32 channels, each a plane [y][x] with row 0 at the top, plus text attributes (provenance).
/// A layer is three channels that share a prefix: layer "" is R,G,B; layer "direct" is direct.R, direct.G, direct.B.
class Image {
 public:
  Image() = default;
  /// @throws Error when a side is below 1 or above 65536
  Image(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  size_t pixel_count() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }

  /// Channel names in the order in which they were added.
  const std::vector<std::string>& channels() const { return names_; }
  bool has(std::string_view channel) const;
  /// Adds a zero-filled channel, or returns the one of that name.
  std::span<float> add(const std::string& channel);
  /// @throws Error naming the channel when there is none
  std::span<const float> channel(std::string_view channel) const;
  std::span<float> channel(std::string_view channel);

  bool has_layer(std::string_view layer) const;
  void add_layer(const std::string& layer);
  /// The layer's three planes. @throws Error naming the channel when one is missing
  std::array<std::span<const float>, 3> layer(std::string_view layer) const;
  std::array<std::span<float>, 3> layer(std::string_view layer);

  std::map<std::string, std::string> attributes;

 private:
  int width_ = 0, height_ = 0;
  std::vector<std::string> names_;
  std::vector<std::vector<float>> planes_;
};

/// The name of channel "R" of layer "direct": "direct.R"; of layer "": "R".
std::string channel_name(std::string_view layer, std::string_view channel);

/// Relative luminance of linear Rec. 709 / sRGB primaries (ITU-R BT.709-6).
inline float luminance(const glm::vec3& rgb) { return 0.2126f * rgb.r + 0.7152f * rgb.g + 0.0722f * rgb.b; }

/// sRGB transfer function of a linear value in [0,1] (IEC 61966-2-1).
float srgb_encode(float linear);

}  // namespace voxref
