#include "compare/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "file.h"
#include "image/image_file.h"
#include "image/planes.h"

namespace voxref {

namespace {

constexpr std::array<Color, 9> cool_warm_points = {{{59, 76, 192},
                                                    {98, 130, 234},
                                                    {141, 176, 254},
                                                    {184, 208, 249},
                                                    {221, 221, 221},
                                                    {245, 196, 173},
                                                    {244, 154, 123},
                                                    {222, 96, 77},
                                                    {180, 4, 38}}};
constexpr std::array<Color, 9> inferno_points = {{{0, 0, 4},
                                                  {33, 12, 74},
                                                  {86, 16, 110},
                                                  {137, 34, 106},
                                                  {187, 55, 84},
                                                  {227, 89, 50},
                                                  {249, 140, 10},
                                                  {249, 201, 50},
                                                  {252, 255, 164}}};

/// Glyphs of 3 x 5 pixels, a row per octal digit from the top, bit 2 on the left.
struct Glyph {
  char character;
  std::array<uint8_t, 5> rows;
};
constexpr int glyph_width = 3, glyph_height = 5, glyph_scale = 2;
constexpr std::array<Glyph, 14> glyphs = {{{'0', {7, 5, 5, 5, 7}},
                                           {'1', {2, 6, 2, 2, 7}},
                                           {'2', {7, 1, 7, 4, 7}},
                                           {'3', {7, 1, 7, 1, 7}},
                                           {'4', {5, 5, 7, 1, 1}},
                                           {'5', {7, 4, 7, 1, 7}},
                                           {'6', {7, 4, 7, 5, 7}},
                                           {'7', {7, 1, 1, 2, 2}},
                                           {'8', {7, 5, 7, 5, 7}},
                                           {'9', {7, 5, 7, 1, 7}},
                                           {'.', {0, 0, 0, 0, 2}},
                                           {'-', {0, 0, 7, 0, 0}},
                                           {'+', {0, 2, 7, 2, 0}},
                                           {'e', {0, 7, 7, 4, 7}}}};

void set(Picture& picture, int x, int y, const Color& color) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  const size_t i = static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x);
  std::copy(color.begin(), color.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
}

int text_width(const std::string& text) {
  return (static_cast<int>(text.size()) * (glyph_width + 1) - 1) * glyph_scale;
}

/// Black text; what leaves the picture is cut off.
void write_text(Picture& picture, int left, int top, const std::string& text) {
  for (const char character : text) {
    const auto glyph =
        std::find_if(glyphs.begin(), glyphs.end(), [&](const Glyph& g) { return g.character == character; });
    assert(glyph != glyphs.end());
    for (int y = 0; y < glyph_height * glyph_scale; ++y)
      for (int x = 0; x < glyph_width * glyph_scale; ++x)
        if (glyph->rows[static_cast<size_t>(y / glyph_scale)] >> (glyph_width - 1 - x / glyph_scale) & 1)
          set(picture, left + x, top + y, {0, 0, 0});
    left += (glyph_width + 1) * glyph_scale;
  }
}

Picture blank(int width, int height) {
  return {width, height, std::vector<uint8_t>(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 255)};
}

void copy_into(Picture& target, const Picture& source, int left) {
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) {
      const size_t i = 3 * (static_cast<size_t>(y) * static_cast<size_t>(source.width) + static_cast<size_t>(x));
      set(target, left + x, y, {source.rgb[i], source.rgb[i + 1], source.rgb[i + 2]});
    }
}

/// The 95th percentile of |value|, rounded up to 1, 2 or 5 times a power of ten; 1 where it is zero.
float rounded_percentile(const std::vector<float>& values) {
  std::vector<float> finite;
  for (const float value : values)
    if (std::isfinite(value)) finite.push_back(std::abs(value));
  if (finite.empty()) return 1.0f;
  const auto rank = finite.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(finite.size() - 1));
  std::nth_element(finite.begin(), rank, finite.end());
  if (*rank < std::numeric_limits<float>::min()) return 1.0f;
  const auto to_float = [](double v) {
    return static_cast<float>(std::min(v, double{std::numeric_limits<float>::max()}));
  };
  const double decade = std::pow(10.0, std::floor(std::log10(double{*rank})));
  for (const double step : {1.0, 2.0, 5.0})
    // The factor keeps a value that is such a number itself, but for rounding, from going one step up.
    if (double{*rank} <= step * decade * (1.0 + 1e-6)) return to_float(step * decade);
  return to_float(10.0 * decade);
}

template <class Function>
ValueMap map_of(const Image& image, Function&& value) {
  ValueMap map{image.width(), image.height(), std::vector<float>(image.pixel_count())};
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = value(i);
  return map;
}

}  // namespace

ColorMap cool_warm() { return cool_warm_points; }
ColorMap inferno() { return inferno_points; }

Color map_color(ColorMap map, float t) {
  if (!std::isfinite(t)) return nonfinite_color;
  const float position = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(map.size() - 1);
  const size_t below = std::min(static_cast<size_t>(position), map.size() - 2);
  const float fraction = position - static_cast<float>(below);
  Color color;
  for (size_t c = 0; c < 3; ++c)
    color[c] = static_cast<uint8_t>(std::lround(static_cast<float>(map[below][c]) * (1.0f - fraction) +
                                                static_cast<float>(map[below + 1][c]) * fraction));
  return color;
}

ValueMap signed_difference(const Image& cone, const Image& path) {
  const auto a = cone.layer(""), b = path.layer("");
  ValueMap map = map_of(cone, [&](size_t i) { return luminance_at(a, i) - luminance_at(b, i); });
  map.high = rounded_percentile(map.values);
  map.low = -map.high;
  return map;
}

ValueMap relative_error(const Image& cone, const Image& path) {
  constexpr double floor_share = 0.01;
  const auto a = cone.layer(""), b = path.layer("");
  double sum = 0.0;
  for (size_t i = 0; i < path.pixel_count(); ++i)
    if (const float value = luminance_at(b, i); std::isfinite(value)) sum += double{value};
  // Where everything is black the ratio 0 / floor must still exist.
  const float floor = std::max(static_cast<float>(floor_share * sum / static_cast<double>(path.pixel_count())),
                               std::numeric_limits<float>::min());
  return map_of(cone, [&](size_t i) {
    const float reference = luminance_at(b, i);
    return std::abs(luminance_at(a, i) - reference) / std::max(reference, floor);
  });
}

ValueMap noise(const Image& path) {
  const std::span<const float> standard_error = path.channel("stderr.Y");
  ValueMap map = map_of(path, [&](size_t i) { return standard_error[i]; });
  map.high = rounded_percentile(map.values);
  return map;
}

Picture display(const Image& image, std::string_view layer, float exposure) {
  Picture picture{image.width(), image.height(), display_bytes(image, layer, exposure)};
  const auto planes = image.layer(layer);
  for (size_t i = 0; i < image.pixel_count(); ++i)
    if (!std::isfinite(planes[0][i]) || !std::isfinite(planes[1][i]) || !std::isfinite(planes[2][i]))
      std::copy(nonfinite_color.begin(), nonfinite_color.end(),
                picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return picture;
}

Picture paint(const ValueMap& map, ColorMap colors) {
  Picture picture{map.width, map.height, {}};
  picture.rgb.reserve(3 * map.values.size());
  for (const float value : map.values) {
    const double low = double{map.low}, span = double{map.high} - low;  // which as a float may be infinite
    const Color color = map_color(colors, static_cast<float>((double{value} - low) / span));
    picture.rgb.insert(picture.rgb.end(), color.begin(), color.end());
  }
  return picture;
}

Picture paint_with_bar(const ValueMap& map, ColorMap colors) {
  constexpr int margin = 4, bar_height = 10;
  const int bar_top = map.height + margin, text_top = bar_top + bar_height + margin;
  Picture picture = blank(map.width, text_top + glyph_height * glyph_scale + margin);
  copy_into(picture, paint(map, colors), 0);
  for (int x = 0; x < map.width; ++x) {
    const Color color = map_color(colors, (static_cast<float>(x) + 0.5f) / static_cast<float>(map.width));
    for (int y = 0; y < bar_height; ++y) set(picture, x, bar_top + y, color);
  }
  const std::string low = fmt::format("{:g}", map.low), middle = fmt::format("{:g}", 0.5f * (map.low + map.high)),
                    high = fmt::format("{:g}", map.high);
  write_text(picture, margin, text_top, low);
  if (text_width(low) + text_width(middle) + text_width(high) + 4 * margin <= map.width)
    write_text(picture, (map.width - text_width(middle)) / 2, text_top, middle);
  write_text(picture, map.width - margin - text_width(high), text_top, high);
  return picture;
}

Picture side_by_side(std::span<const Picture> pictures) {
  constexpr int gap = 8;
  int width = -gap;
  for (const Picture& picture : pictures) {
    assert(picture.height == pictures.front().height);
    width += picture.width + gap;
  }
  Picture strip = blank(width, pictures.front().height);
  int left = 0;
  for (const Picture& picture : pictures) {
    copy_into(strip, picture, left);
    left += picture.width + gap;
  }
  return strip;
}

void write_png(const std::filesystem::path& file, const Picture& picture) {
  const std::vector<uint8_t> content = encode_png(picture.width, picture.height, picture.rgb);
  write_atomically(file, std::as_bytes(std::span(content)));
}

}  // namespace voxref
