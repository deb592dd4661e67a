#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "catch.h"
#include "cone/interpolate_wide.h"

using namespace voxref;

namespace {

/// A brick of random texels in all faces.
template <class Texel>
BrickVolume<Directional<Texel>> random_brick(std::mt19937& random) {
  std::uniform_real_distribution<float> value(0.0f, 1.0f);
  BrickVolume<Directional<Texel>> volume(glm::ivec3(8));
  volume.allocate(std::vector{glm::ivec3(0)});
  for (Directional<Texel>& faces : volume.texels())
    for (Texel& texel : faces)
      texel = encode<Texel>(Float4{value(random), value(random), value(random), value(random)});
  return volume;
}

/// The same eight texels, as a brick's and as any eight.
template <class Texel, class Read>
void check_alike(const char* name) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> inside(0.0f, 1.0f);
  const BrickVolume<Directional<Texel>> volume = random_brick<Texel>(random);
  for (int i = 0; i < 200; ++i) {
    const BrickCorners<Directional<Texel>> together{&volume(glm::ivec3(random() % 7, random() % 7, random() % 7))};
    Corners<Directional<Texel>> apart;
    for (size_t k = 0; k < 8; ++k) apart.texels[k] = &together[k];
    const auto shares = corner_shares(Float4{inside(random), inside(random), inside(random), 0.0f});
    const Read read(glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));  // all octants
    const Float4 plain = PlainKernel::interpolate(apart, shares, read);
    for (const Float4& wide :
         {WideKernel::interpolate(apart, shares, read), WideKernel::interpolate(together, shares, read)})
      for (int channel = 0; channel < 4; ++channel) {
        CAPTURE(name, i, channel);
        // 24 products, each rounded by 2^-24 of at most the greatest sum, and so are their sums.
        REQUIRE(wide[channel] == Approx(plain[channel]).epsilon(2e-6));
      }
  }
}

}  // namespace

TEST_CASE("Corners count as in interpolation along one axis after the other", "[interpolate]") {
  const Float4 f{0.25f, 0.5f, 0.75f, 0.0f};
  const auto shares = corner_shares(f);
  for (size_t i = 0; i < 8; ++i) {
    float share = 1.0f;
    for (int axis = 0; axis < 3; ++axis) share *= i >> axis & 1 ? f[axis] : 1.0f - f[axis];
    CHECK(shares[i] == share);  // dyadic numbers
  }
}

TEST_CASE("Two texels at a time interpolate to what they do one by one, in every storage", "[interpolate]") {
  if (!wide_machine) VOXREF_SKIP("this machine has no AVX2");
  check_alike<glm::vec4, SquaredRead>("float32, squared");
  check_alike<Rgba16f, SquaredRead>("float16, squared");
  check_alike<Rgba8, SquaredRead>("unorm8, squared");
  check_alike<glm::vec4, OpticalRead>("float32, optical");
  check_alike<Rgba16f, OpticalRead>("float16, optical");
  check_alike<Rgba8, OpticalRead>("unorm8, optical");
}
