#include "scene/texture.h"

#include <cmath>

#include "catch.h"

using namespace voxref;

namespace {

/// 2x2 texels with red 0, 255 / 255, 0 and alpha 255.
TextureImage checker() {
  TextureImage image;
  image.width = image.height = 2;
  image.texels8 = {0, 10, 20, 255, 255, 10, 20, 255, 255, 10, 20, 255, 0, 10, 20, 255};
  return image;
}

TextureBinding binding_of(Wrap wrap, bool nearest = false) {
  TextureBinding binding;
  binding.image = 0;
  binding.wrap_s = binding.wrap_t = wrap;
  binding.nearest = nearest;
  return binding;
}

}  // namespace

TEST_CASE("texel centres lie at half-integers and row 0 is at v = 0", "[texture]") {
  const TextureBinding clamp = binding_of(Wrap::clamp);
  CHECK(lookup(checker(), clamp, {0.25f, 0.25f}).r == 0.0f);
  CHECK(lookup(checker(), clamp, {0.75f, 0.25f}).r == 1.0f);
  CHECK(lookup(checker(), clamp, {0.25f, 0.75f}).r == 1.0f);
  CHECK(lookup(checker(), clamp, {0.5f, 0.25f}).r == 0.5f);
  CHECK(lookup(checker(), clamp, {0.5f, 0.5f}).r == 0.5f);
  CHECK(lookup(checker(), clamp, {0.25f, 0.25f}).g == Approx(10.0 / 255.0));
}

TEST_CASE("wrap modes continue the image as glTF says", "[texture]") {
  const TextureImage image = checker();
  CHECK(lookup(image, binding_of(Wrap::repeat), {1.25f, -0.75f}).r == 0.0f);
  CHECK(lookup(image, binding_of(Wrap::repeat), {0.0f, 0.25f}).r == 0.5f);  // between the last texel and the first
  CHECK(lookup(image, binding_of(Wrap::mirror), {1.25f, 0.25f}).r == 1.0f);
  CHECK(lookup(image, binding_of(Wrap::mirror), {-0.25f, 0.25f}).r == 0.0f);
  CHECK(lookup(image, binding_of(Wrap::clamp), {-7.0f, 0.25f}).r == 0.0f);
  CHECK(lookup(image, binding_of(Wrap::clamp), {7.0f, 0.25f}).r == 1.0f);
}

TEST_CASE("NEAREST takes the texel without mixing", "[texture]") {
  CHECK(lookup(checker(), binding_of(Wrap::clamp, true), {0.49f, 0.25f}).r == 0.0f);
  CHECK(lookup(checker(), binding_of(Wrap::clamp, true), {0.51f, 0.25f}).r == 1.0f);
}

TEST_CASE("sRGB texels are decoded before they are mixed, alpha never", "[texture]") {
  TextureImage image = checker();
  image.texels8[3] = 128;
  TextureBinding binding = binding_of(Wrap::clamp);
  binding.srgb = true;
  // Half black, half white is 0.5 in light; mixing codes first would give 0.214.
  CHECK(lookup(image, binding, {0.5f, 0.25f}).r == Approx(0.5f));
  CHECK(lookup(image, binding, {0.25f, 0.25f}).a == Approx(128.0 / 255.0));
  // IEC 61966-2-1 at code 20: below the linear segment's end (0.04045 x 255 = 10.3) the power law does not hold yet.
  CHECK(lookup(image, binding, {0.25f, 0.25f}).b == Approx(std::pow((20.0 / 255.0 + 0.055) / 1.055, 2.4)));
  CHECK(lookup(image, binding, {0.25f, 0.25f}).g == Approx(10.0 / 255.0 / 12.92));
}

TEST_CASE("16-bit texels keep their precision", "[texture]") {
  TextureImage image;
  image.width = image.height = 1;
  image.texels16 = {1, 32768, 65535, 65535};
  const glm::vec4 texel = lookup(image, binding_of(Wrap::repeat), {0.3f, 0.9f});
  CHECK(texel.r == Approx(1.0 / 65535.0));
  CHECK(texel.g == Approx(32768.0 / 65535.0));
}

TEST_CASE("the texture transform moves coordinates before wrapping", "[texture]") {
  TextureBinding binding = binding_of(Wrap::repeat);
  binding.transform = glm::mat3x2(1.0f, 0.0f, 0.0f, 1.0f, 0.5f, 0.0f);  // offset (0.5, 0)
  CHECK(lookup(checker(), binding, {0.25f, 0.25f}).r == 1.0f);
}

TEST_CASE("coordinates beyond an int's range still name a texel", "[texture]") {
  CHECK(std::isfinite(lookup(checker(), binding_of(Wrap::repeat), {1e30f, -1e30f}).r));
}
