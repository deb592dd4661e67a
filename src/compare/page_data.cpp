#include "compare/page_data.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
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

/// Mantissas of so many bits that the channels of a pixel share an exponent for.
struct Packing {
  int bits = 8;
  bool with_sign = false;  ///< then at most 7 bits
};

/// Four bytes per pixel, Ward 1991: mantissas that share the exponent of the largest; exponent byte 255 stands for a
/// pixel that is not finite. Signed ones have 128 added. Laid out as a picture, for PNG compresses it well: `height`
/// rows of mantissas as R,G,B, below them the exponents, those of three rows as the R,G,B of one.
std::vector<uint8_t> shared_exponent_rows(const Image& image, const Packing& packing) {
  const auto planes = image.layer("");
  const auto width = static_cast<size_t>(image.width()), height = static_cast<size_t>(image.height());
  const size_t exponent_rows = (height + 2) / 3;
  const int bits = packing.bits;
  const long zero = packing.with_sign ? 128 : 0, largest_mantissa = (1 << bits) - 1;
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
        bytes[3 * i + c] = static_cast<uint8_t>(
            zero + std::clamp(mantissa, packing.with_sign ? -largest_mantissa : 0L, largest_mantissa));
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

std::string encoded(const Image& image, const Packing& packing) {
  const std::vector<uint8_t> bytes = shared_exponent_rows(image, packing);
  return base64(encode_png(image.width(), image.height() + (image.height() + 2) / 3, bytes));
}

bool has_all(const Image& image, const std::vector<std::string>& layers) {
  return std::ranges::all_of(layers, [&](const std::string& layer) { return image.has_layer(layer); });
}

Image difference_of(const Image& a, const Image& b) {
  Image result(a.width(), a.height());
  result.add_layer("");
  for (size_t c = 0; c < 3; ++c)
    std::ranges::transform(a.layer("")[c], b.layer("")[c], result.layer("")[c].begin(), std::minus());
  return result;
}

/// A pair of layers as the script takes it; none where its texts are longer than `room` bytes in all. Where two
/// pictures are nearly the same their difference drowns in the rounding of either, so it is kept apart, as sharp as
/// there is room.
std::optional<nlohmann::json> page_layer(const std::string& name, const Image& a, const Image& b, size_t room) {
  const bool with_sign = has_negative(a) || has_negative(b);
  const Packing values{with_sign ? 7 : 8, with_sign};
  nlohmann::json layer = {{"name", name},
                          {"bits", values.bits},
                          {"signed", with_sign},
                          {"a", encoded(a, values)},
                          {"b", encoded(b, values)}};
  const size_t taken =
      layer["a"].get_ref<const std::string&>().size() + layer["b"].get_ref<const std::string&>().size();
  const Image difference = difference_of(a, b);
  constexpr int most_bits = 7, least_bits = 3;  // errors of 0.8 % and 12.5 % of the largest channel
  for (int bits = most_bits; bits >= least_bits; --bits) {
    std::string text = encoded(difference, {bits, true});
    if (taken + text.size() > room) continue;
    layer["difference"] = std::move(text);
    layer["difference_bits"] = bits;
    return layer;
  }
  return std::nullopt;
}

size_t text_bytes(const nlohmann::json& layer) {
  size_t bytes = 0;
  for (const char* key : {"a", "b", "difference"}) bytes += layer[key].get_ref<const std::string&>().size();
  return bytes;
}

/// The layers that both images have and that there is room for, in their order.
nlohmann::json page_layers(const ComparisonPage& page, int factor) {
  nlohmann::json layers = nlohmann::json::array();
  size_t room = most_layer_bytes;
  for (const PageLayer& pair : page.layers) {
    if (!has_all(page.a, pair.a) || !has_all(page.b, pair.b)) continue;
    std::optional<nlohmann::json> layer =
        page_layer(pair.name, reduced(page.a, pair.a, factor), reduced(page.b, pair.b, factor), room);
    if (!layer) break;
    room -= text_bytes(*layer);
    layers.push_back(std::move(*layer));
  }
  return layers;
}

}  // namespace

nlohmann::json page_data(const ComparisonPage& page) {
  assert(std::ranges::any_of(
      page.layers, [&](const PageLayer& pair) { return has_all(page.a, pair.a) && has_all(page.b, pair.b); }));
  int factor = reduction(page.a);
  nlohmann::json layers = page_layers(page, factor);
  while (layers.empty()) layers = page_layers(page, ++factor);
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
