#include "compare/page_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "compare/picture.h"
#include "image/image_file.h"

namespace voxref {

namespace {

constexpr size_t most_pixels = size_t{512} * 512;
/// Of all embedded layers in base64. 3 MiB less the room for the template and the tables.
constexpr size_t most_layer_bytes = (size_t{3} * 1024 - 160) * 1024;

bool has_negative(const Image& image) {
  const auto planes = image.layer("");
  return std::ranges::any_of(planes, [](std::span<const float> plane) {
    return std::ranges::any_of(plane, [](float v) { return v < 0.0f; });
  });
}

/// Four bytes per pixel, Ward 1991: mantissas of 8 bits that share the exponent of the largest; exponent byte 255
/// stands for a pixel that is not finite. Signed ones have 7 bits, and 128 added. Laid out as a picture, for PNG
/// compresses it well: `height` rows of mantissas as R,G,B, below them the exponents, those of three rows as the R,G,B
/// of one.
std::vector<uint8_t> shared_exponent_rows(const Image& image, bool with_sign) {
  const auto planes = image.layer("");
  const auto width = static_cast<size_t>(image.width()), height = static_cast<size_t>(image.height());
  const size_t exponent_rows = (height + 2) / 3;
  const int bits = with_sign ? 7 : 8;
  const long zero = with_sign ? 128 : 0, largest_mantissa = (1 << bits) - 1;
  std::vector<uint8_t> bytes(3 * width * (height + exponent_rows), 0);
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x) {
      const size_t i = y * width + x;
      const std::array<float, 3> rgb = {planes[0][i], planes[1][i], planes[2][i]};
      for (size_t c = 0; c < 3; ++c) bytes[3 * i + c] = static_cast<uint8_t>(zero);
      uint8_t& shared = bytes[3 * ((height + y / 3) * width + x) + y % 3];
      if (!std::all_of(rgb.begin(), rgb.end(), [](float v) { return std::isfinite(v); })) {
        shared = 255;
        continue;
      }
      const float largest = std::max({std::abs(rgb[0]), std::abs(rgb[1]), std::abs(rgb[2])});
      if (largest == 0.0f) continue;
      int exponent = 0;
      // So that rounding the largest gives the largest mantissa at most.
      std::frexp(largest * (static_cast<float>(largest_mantissa + 1) / (static_cast<float>(largest_mantissa) + 0.5f)),
                 &exponent);
      exponent = std::clamp(exponent, -127, 126);
      shared = static_cast<uint8_t>(exponent + 128);
      for (size_t c = 0; c < 3; ++c) {
        const long mantissa = std::lround(std::ldexp(rgb[c], bits - exponent));
        bytes[3 * i + c] = static_cast<uint8_t>(zero + std::clamp(mantissa, -zero, largest_mantissa));
      }
    }
  return bytes;
}

std::string base64(std::span<const uint8_t> bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t present = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < present ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= present ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// The whole factor by which the page's images are smaller than the check's.
int reduction(const Image& image) {
  int factor = 1;
  const auto side = [&](int length) { return static_cast<size_t>((length + factor - 1) / factor); };
  while (side(image.width()) * side(image.height()) > most_pixels) ++factor;
  return factor;
}

/// Sum of layers as layer "" of a smaller image, each pixel the mean of factor x factor; cut blocks at the right and
/// lower edge.
Image reduced(const Image& image, std::span<const std::string> layers, int factor) {
  Image result((image.width() + factor - 1) / factor, (image.height() + factor - 1) / factor);
  result.add_layer("");
  std::vector<float> pixels(result.pixel_count(), 0.0f);
  const auto block = [&](int x, int y) {
    return static_cast<size_t>(y / factor) * static_cast<size_t>(result.width()) + static_cast<size_t>(x / factor);
  };
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) pixels[block(x, y)] += 1.0f;
  const auto target = result.layer("");
  for (const std::string& layer : layers) {
    const auto source = std::as_const(image).layer(layer);
    for (size_t c = 0; c < 3; ++c)
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
          const size_t to = block(x, y), width = static_cast<size_t>(image.width());
          target[c][to] += source[c][static_cast<size_t>(y) * width + static_cast<size_t>(x)] / pixels[to];
        }
  }
  return result;
}

std::string encoded(const Image& image, bool with_sign) {
  const std::vector<uint8_t> bytes = shared_exponent_rows(image, with_sign);
  return base64(encode_png(image.width(), image.height() + (image.height() + 2) / 3, bytes));
}

bool has_all(const Image& image, const std::vector<std::string>& layers) {
  return std::ranges::all_of(layers, [&](const std::string& layer) { return image.has_layer(layer); });
}

}  // namespace

nlohmann::json page_data(const ComparisonPage& page) {
  const int factor = reduction(page.a);
  nlohmann::json layers = nlohmann::json::array();
  size_t bytes = 0;
  for (const PageLayer& pair : page.layers) {
    if (!has_all(page.a, pair.a) || !has_all(page.b, pair.b)) continue;
    const Image a = reduced(page.a, pair.a, factor), b = reduced(page.b, pair.b, factor);
    const bool with_sign = has_negative(a) || has_negative(b);
    std::string data_a = encoded(a, with_sign), data_b = encoded(b, with_sign);
    if (bytes + data_a.size() + data_b.size() > most_layer_bytes) break;
    bytes += data_a.size() + data_b.size();
    layers.push_back({{"name", pair.name}, {"signed", with_sign}, {"a", std::move(data_a)}, {"b", std::move(data_b)}});
  }
  return {{"width", (page.a.width() + factor - 1) / factor},
          {"height", (page.a.height() + factor - 1) / factor},
          {"factor", factor},
          {"exposure", page.exposure},
          {"names", {{"a", page.name_a}, {"b", page.name_b}}},
          {"layers", std::move(layers)},
          {"cool_warm", std::vector<Color>(cool_warm().begin(), cool_warm().end())},
          {"inferno", std::vector<Color>(inferno().begin(), inferno().end())},
          {"nonfinite_color", nonfinite_color}};
}

}  // namespace voxref
