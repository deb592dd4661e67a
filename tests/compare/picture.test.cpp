#include "compare/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "catch.h"
#include "compare/synthetic.h"
#include "image/image_file.h"
#include "temporary_folder.h"

using voxref::Color;
using voxref::Image;
using voxref::map_color;
using voxref::Picture;
using voxref::ValueMap;
using voxref::testing::cone_image;
using voxref::testing::path_image;
using voxref::testing::wavy;

namespace {
constexpr auto flat = [](float value) { return [value](int, int) { return glm::vec3(value); }; };
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

Color pixel_of(const Picture& picture, int x, int y) {
  const auto i = static_cast<size_t>(3 * (y * picture.width + x));
  return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}
}  // namespace

TEST_CASE("Colour maps have their published ends and middle, and show what is not finite", "[compare]") {
  CHECK(map_color(voxref::cool_warm(), 0.0f) == Color{59, 76, 192});
  CHECK(map_color(voxref::cool_warm(), 0.5f) == Color{221, 221, 221});
  CHECK(map_color(voxref::cool_warm(), 2.0f) == Color{180, 4, 38});
  CHECK(map_color(voxref::inferno(), -1.0f) == Color{0, 0, 4});
  CHECK(map_color(voxref::inferno(), 1.0f) == Color{252, 255, 164});
  CHECK(map_color(voxref::inferno(), not_a_number) == voxref::nonfinite_color);
}

TEST_CASE("Inferno grows lighter all along", "[compare]") {
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const Color color = map_color(voxref::inferno(), static_cast<float>(i) / 100.0f);
    const auto linear = [](uint8_t byte) { return std::pow(byte / 255.0, 2.2); };
    const double luminance = 0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2]);
    CHECK(luminance > before - 1e-5);  // bytes are rounded
    before = luminance;
  }
}

TEST_CASE("The signed difference is blue where the cone tracer is darker and red where it is brighter", "[compare]") {
  const Image path = path_image(20, 10, flat(0.5f));
  const Image cone = cone_image(20, 10, [](int x, int) { return glm::vec3(x < 10 ? 0.47f : 0.53f); });
  const ValueMap map = signed_difference(cone, path);
  CHECK(map.values[0] == Approx(-0.03f).epsilon(1e-5));
  CHECK(map.high == Approx(0.05f));  // 0.03 rounded up to 1, 2 or 5 times a power of ten
  CHECK(map.low == -map.high);
  const Picture picture = paint(map, voxref::cool_warm());
  const Color darker = pixel_of(picture, 0, 0), brighter = pixel_of(picture, 19, 9);
  CHECK(darker[2] > darker[0] + 50);
  CHECK(brighter[0] > brighter[2] + 50);
}

TEST_CASE("Colour bars end at 1, 2 or 5 times a power of ten", "[compare]") {
  const auto end = [](float difference) {
    return signed_difference(cone_image(4, 4, flat(1.0f + difference)), path_image(4, 4, flat(1.0f))).high;
  };
  CHECK(end(0.0f) == 1.0f);
  CHECK(end(0.125f) == Approx(0.2f));
  CHECK(end(0.5f) == Approx(0.5f));
  CHECK(end(0.75f) == Approx(1.0f));
  CHECK(end(1024.0f) == Approx(2000.0f));
}

TEST_CASE("The relative error is over the reference, or over one percent of its mean where that is darker",
          "[compare]") {
  const Image path = path_image(100, 1, [](int x, int) { return glm::vec3(x == 0 ? 0.0f : 1.0f); });
  const Image cone = cone_image(100, 1, [](int x, int) { return glm::vec3(x == 0 ? 0.001f : 0.9f); });
  const ValueMap map = relative_error(cone, path);
  CHECK(map.values[0] == Approx(0.001 / (0.01 * 0.99)).epsilon(1e-4));
  CHECK(map.values[50] == Approx(0.1).epsilon(1e-5));
  const ValueMap black = relative_error(cone_image(4, 4, flat(0.0f)), path_image(4, 4, flat(0.0f)));
  CHECK(black.values == std::vector<float>(16, 0.0f));
}

TEST_CASE("A pixel that is not finite is marked in every picture", "[compare]") {
  Image cone = cone_image(8, 8, wavy);
  Image path = path_image(8, 8, wavy, 0.1f);
  cone.channel("R")[9] = not_a_number;
  path.channel("stderr.Y")[9] = std::numeric_limits<float>::infinity();
  CHECK(pixel_of(display(cone, "", 0.0f), 1, 1) == voxref::nonfinite_color);
  CHECK(pixel_of(paint(signed_difference(cone, path), voxref::cool_warm()), 1, 1) == voxref::nonfinite_color);
  CHECK(pixel_of(paint(relative_error(cone, path), voxref::inferno()), 1, 1) == voxref::nonfinite_color);
  CHECK(pixel_of(paint(noise(path), voxref::inferno()), 1, 1) == voxref::nonfinite_color);
  CHECK(pixel_of(display(cone, "", 0.0f), 2, 1) != voxref::nonfinite_color);
}

TEST_CASE("The colour bar runs over the map's colours below it, with numbers under it", "[compare]") {
  const ValueMap map = noise(path_image(200, 10, wavy, 0.3f));
  const Picture picture = paint_with_bar(map, voxref::inferno());
  CHECK(picture.width == 200);
  CHECK(picture.height > 10);
  CHECK(pixel_of(picture, 100, 5) == map_color(voxref::inferno(), 0.3f / 0.5f));
  const int bar_row = 10 + 8;
  CHECK(pixel_of(picture, 0, bar_row) == map_color(voxref::inferno(), 0.5f / 200.0f));
  CHECK(pixel_of(picture, 199, bar_row) == map_color(voxref::inferno(), 199.5f / 200.0f));
  const auto black = std::count(picture.rgb.end() - 3 * 200 * 14, picture.rgb.end(), uint8_t{0});
  // "0", "0.25", "0.5": 12, 12 + 1 + 11 + 11 and 12 + 1 + 11 dots of 2 x 2 pixels in three channels.
  CHECK(black == 12 * (12 + 35 + 24));
}

TEST_CASE("Pictures stand side by side with a white gap and survive the file", "[compare]") {
  const Picture dark = display(cone_image(5, 4, flat(0.0f)), "", 0.0f);
  const Picture strip = voxref::side_by_side(std::array{dark, dark, dark});
  CHECK(strip.width == 3 * 5 + 2 * 8);
  CHECK(pixel_of(strip, 4, 3) == Color{0, 0, 0});
  CHECK(pixel_of(strip, 5, 3) == Color{255, 255, 255});
  CHECK(pixel_of(strip, 13, 0) == Color{0, 0, 0});

  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "strip.png";
  write_png(file, strip);
  const Image read = voxref::read_image(file);
  REQUIRE(read.width() == strip.width);
  CHECK(read.channel("R")[4] == 0.0f);
  CHECK(read.channel("R")[5] == 1.0f);
}

TEST_CASE("A picture of the largest floats has a bar with numbers", "[compare]") {
  // As a distance layer has them where nothing was hit.
  const float most = std::numeric_limits<float>::max();
  const Image far = cone_image(200, 10, [&](int, int) { return glm::vec3(0.9f * most); });
  const ValueMap map = signed_difference(far, cone_image(200, 10, flat(0.0f)));
  CHECK(std::isfinite(map.high));
  CHECK(map.low == -map.high);
  const Picture picture = paint_with_bar(map, voxref::cool_warm());
  CHECK(pixel_of(picture, 100, 5) == map_color(voxref::cool_warm(), 0.95f));
}
