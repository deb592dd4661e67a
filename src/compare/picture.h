#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace voxref {

using Color = std::array<uint8_t, 3>;  ///< sRGB

/// What a pixel that is NaN or infinite looks like in every picture: magenta, which no colour map contains.
inline constexpr Color nonfinite_color = {255, 0, 255};

/// 8-bit RGB ready to be shown, rows from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  ///< 3 * width * height
};

/// Control points at equal distances over [0,1], linear in between.
using ColorMap = std::span<const Color>;
/// Blue, grey, red: Moreland 2009, "Diverging Color Maps for Scientific Visualization".
ColorMap cool_warm();
/// Black, purple, orange, pale yellow, perceptually uniform: inferno of van der Walt and Smith 2015 (matplotlib).
ColorMap inferno();
/// @param t clamped to [0,1]; nonfinite_color for NaN and infinity
Color map_color(ColorMap map, float t);

/// One number per pixel, and the range that its colours span.
struct ValueMap {
  int width = 0, height = 0;
  std::vector<float> values;
  float low = 0, high = 1;  ///< the ends of the colour bar
};

/// Luminance of cone - path, radiance: negative (blue) where the cone tracer is darker. The bar is symmetric: the 95th
/// percentile of the absolute value, rounded up to 1, 2 or 5 times a power of ten; 1 where the images are equal.
ValueMap signed_difference(const Image& cone, const Image& path);
/// |cone - path| / max(path, floor) of the luminances, floor = 1 % of the path-traced mean, over [0,1].
ValueMap relative_error(const Image& cone, const Image& path);
/// Standard error of the path-traced luminance (stderr.Y), radiance, over [0, 95th percentile, rounded up as above].
ValueMap noise(const Image& path);

/// The layer as displayed: x 2^exposure, clipped, sRGB.
Picture display(const Image& image, std::string_view layer, float exposure);
/// The map in colours.
Picture paint(const ValueMap& map, ColorMap colors);
/// The same with a bar of the colours below it, and the numbers of the bar's ends and middle.
Picture paint_with_bar(const ValueMap& map, ColorMap colors);
/// Pictures of equal height side by side, white between them.
Picture side_by_side(std::span<const Picture> pictures);

/// A PNG file, whole or not at all. @throws Error with the path when it cannot be written
void write_png(const std::filesystem::path& file, const Picture& picture);

}  // namespace voxref
